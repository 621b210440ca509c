// A hard clip with its truth, drawn frame by frame: three markers on white plates before tissue, area-sampled
// over pixel and exposure through the exact camera, what comes between, blur of the optics, gain, noise, tone
// curve, and what a recorder does to it. Shares no code with the tracker or with the simulator's renderer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/benchmarks/hard_clips/recipe.h"

namespace arthronaut::hard_clips {

struct MarkerTruth {
  int id = 0;
  // In the middle of the exposure of the row that its centre is in; of two fields, between them.
  geometry::RigidTransform camera_from_marker;
  bool is_in_view = false;            // all of it
  double visible_share = 0;           // of its area, not covered and in the view
  double saturated_share = 0;         // of its area
  double side_px = 0, motion_px = 0;  // shortest side; mean way over the exposure
  [[nodiscard]] bool is_whole() const { return is_in_view && visible_share > 0.999; }
  [[nodiscard]] bool is_half_covered() const { return visible_share >= 0.5 && visible_share <= 0.9; }
};

class HardClip {
 public:
  // Frames that were drawn before are taken from the cache folder, and put there; an empty path: none.
  explicit HardClip(const ClipRecipe& recipe, std::filesystem::path cache = {});
  ~HardClip();

  // The next picture's luma, valid until the next call; null data at the end.
  [[nodiscard]] camera::GrayView next();
  [[nodiscard]] const std::vector<MarkerTruth>& truth() const;  // of that picture
  [[nodiscard]] std::int64_t timestamp_ns() const;
  [[nodiscard]] const camera::CameraModel& camera() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::hard_clips
