// The registered bone against the picture, frame by frame: does the bone lie in the picture where its marker
// and the registration say? A bumped marker or a bone that slipped shows as an outline, and a surface, that
// stand elsewhere, without a touch.
//
// Two things are asked. The outline (visible_bone.h, edge_search.h): where the surface turns away from the
// lens there must be an edge in the picture. It is asked against where the outline stood when the
// registration had just been confirmed, since the model may be bare bone where the picture shows cartilage,
// and no registration is exact. The surface (surface_memory.h): what it looked like then must still lie where
// it lay. Both by one sequential test (drift_test.h).
//
// A bone that was knocked further than the test compares looks like another one where it lay, all of it at
// once. That is watched for by itself (knock_watch.h): it is found again up to 8 mm off and told as a drift,
// or it is said that it does not look as it did.
//
// It can raise a doubt and nothing else: that nothing is seen to have moved makes no registration more sure.
// It does not see what is along the line of sight alone, what moves while nothing of the bone is in view, nor
// how far a registration was off from its beginning. What cannot be told is NotChecked, with the reason.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/contour/contour_verdict.h"
#include "navigation/contour/drift_test.h"
#include "navigation/contour/knock_watch.h"
#include "navigation/contour/surface_memory.h"
#include "navigation/contour/visible_bone.h"

namespace arthronaut::contour {

struct ContourOptions {
  // An outline bends as the lens goes round the bone, and what lies behind it changes: more has to speak for
  // a drift than of the surface, which is compared with itself.
  DriftTestOptions outline = {.lead_pieces = 3,
                              .lead_share = 0.3,
                              .fits_share = 0,
                              .seen_pieces = 3,
                              .seen_share = 0.3,
                              .holds_s = 0.5};
  DriftTestOptions surface;
  KnockOptions knock;
  double settle_s = 1.0;  // with pictures that show enough; a gap between two is not looked at
  // A surface that shows this share of drifts, and none, is believed before the outline: it is compared with
  // itself.
  double belies_from_share = 0.5;
  // Before it counts as seen to hold: a score may lag behind a bone that has moved by so many of its
  // memories.
  double lag_memories = 4;
};

// Allocates nothing after the construction and reserve_for(). One thread at a time; deterministic: the work
// of a frame is counted, not timed.
class ContourCheck {
 public:
  // mesh: closed, outward, bone frame, mm. Throws InvalidInput when it is empty.
  explicit ContourCheck(const geometry::TriangleMesh& mesh, const ContourOptions& options = {});

  // Pictures of up to that size will come.
  void reserve_for(const Eigen::Vector2i& image_size_px) {
    visible_.reserve_for(image_size_px);
    knock_.reserve_for(image_size_px);
  }
  // A registration stands from now on: what was seen under another one is forgotten, and a drift is over.
  void begin(const geometry::RigidTransform& world_from_bone);
  // None stands any more.
  void end();
  [[nodiscard]] bool has_begun() const { return has_begun_; }

  // Frames in order of time. `camera` is the frame's; no pose: the bone's marker was not tracked in it, or
  // the picture stands for nothing.
  const ContourVerdict& look(const camera::GrayView& luma, const camera::CameraModel& camera,
                             const std::optional<geometry::RigidTransform>& camera_from_world,
                             std::span<const Covered> covered, std::int64_t timestamp_ns);
  [[nodiscard]] const ContourVerdict& verdict() const { return verdict_; }
  [[nodiscard]] const DriftTest& outline_test() const { return outline_test_; }
  [[nodiscard]] const DriftTest& surface_test() const { return surface_test_; }
  [[nodiscard]] const KnockWatch& knock() const { return knock_; }
  [[nodiscard]] const VisibleBone& visible() const { return visible_; }

 private:
  void ask_outline(const camera::GrayView& luma, const camera::CameraModel& camera,
                   const geometry::RigidTransform& camera_from_bone, std::span<const Covered> covered);
  void ask_surface(const camera::GrayView& luma, const camera::CameraModel& camera,
                   const geometry::RigidTransform& camera_from_bone, std::span<const Covered> covered,
                   bool may_keep);
  [[nodiscard]] bool is_still(const camera::CameraModel& camera,
                              const geometry::RigidTransform& camera_from_bone) const;
  void conclude(double elapsed_s);
  void note_held(bool outline_counts, bool surface_counts);

  ContourOptions options_;
  VisibleBone visible_;
  SurfaceMemory memory_;
  DriftTest outline_test_, surface_test_;
  KnockWatch knock_;
  bool has_begun_ = false, has_seen_bone_ = false, has_outline_reference_ = false;
  geometry::RigidTransform world_from_bone_;
  std::optional<geometry::RigidTransform> camera_from_bone_before_;
  std::int64_t time_before_ns_ = 0;
  double outline_settled_s_ = 0, surface_settled_s_ = 0;
  std::size_t next_outline_ = 0, next_place_ = 0;
  ContourVerdict verdict_;
};

}  // namespace arthronaut::contour
