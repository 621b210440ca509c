// A path-traced clip with its truth, frame by frame.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/tools/tool_set.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::real_data {

struct TrueMarker {
  geometry::RigidTransform camera_from_marker;
  std::array<Eigen::Vector2d, 4> corners_px;
  bool in_view = false;
  double visible_share = 0, shortest_side_px = 0, motion_px = 0;
  // Nothing in front of it and no corner hidden.
  bool is_whole = false;
};

struct TrueFrame {
  double time_s = 0;
  double mark_angle_deg = 0;
  std::map<int, TrueMarker> markers;  // by id
};

// Throws what the readers throw.
class MarkerClip {
 public:
  explicit MarkerClip(const std::filesystem::path& folder);
  ~MarkerClip();

  // The next picture, as luma; nullopt-like nullptr data at the end.
  [[nodiscard]] camera::GrayView next_picture();
  void rewind();
  // Of the picture that next_picture returned last.
  [[nodiscard]] const TrueFrame& truth() const;
  // The true camera of that picture in the clip's fluid.
  [[nodiscard]] camera::CameraModel camera() const;
  [[nodiscard]] camera::CameraModel camera(const camera::Calibration& calibration) const;
  [[nodiscard]] std::int64_t timestamp_ns() const;

  [[nodiscard]] const tools::ToolSet& tools() const { return tools_; }
  [[nodiscard]] const camera::Calibration& calibration() const { return calibration_; }
  [[nodiscard]] std::size_t frame_count() const { return frames_.size(); }
  // Decodes what is left and keeps it, so that a tracker can be timed without the decoder.
  [[nodiscard]] std::vector<std::vector<std::uint8_t>> all_pictures();

 private:
  struct Video;
  std::filesystem::path folder_;
  tools::ToolSet tools_;
  camera::Calibration calibration_;
  std::vector<TrueFrame> frames_;
  std::unique_ptr<Video> video_;
  std::size_t next_ = 0;
};

}  // namespace arthronaut::real_data
