// The printed code as an exposure shows it: looked at along one pixel's ray at several moments of the
// exposure and smeared by the optics. Pure mathematics on the marker's plane; the camera enters by the ray
// alone.
#pragma once

#include <Eigen/Core>

#include "navigation/markers/exposed_kernel.h"
#include "navigation/markers/marker_pattern.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

// How a marker moves while the shutter is open: at the time t from the middle, counted in exposures from -0.5
// to 0.5, it stands at camera_from_marker * exp(t velocity + t^2 / 2 change). Body twists (v mm, w rad).
struct ExposedPose {
  geometry::RigidTransform camera_from_marker;
  geometry::Vector6d velocity = geometry::Vector6d::Zero(), change = geometry::Vector6d::Zero();
};

class ExposedCode {
 public:
  ExposedCode(const MarkerCode& code, double size_mm);

  // Sets the motion for the calls that follow, looked at in so many moments (1 to kMaxMoments).
  void move(const ExposedPose& pose, int moment_count);
  static constexpr int kMaxMoments = ExposedMoments::kMost;
  // One moment, in the middle of the exposure, shows none: its derivatives by velocity and change are zero.
  [[nodiscard]] bool shows_motion() const { return code_.count > 1; }

  // Along eight rays at once, smeared by sigmas in cells along the marker's x and y: 0 dark, 1 bright; the
  // margin of one cell around the square is bright. A cell must be at least two and a half sigma wide.
  void look(const LookedAt& at, SeenLevels& levels) const;
  // The same levels without their derivatives, which are left as they were.
  void look_at_level(const LookedAt& at, SeenLevels& levels) const;

 private:
  ExposedMoments code_;
};

}  // namespace arthronaut::markers
