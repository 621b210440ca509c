// The ball of rendered_bone.h watched by the check, fifteen pictures a second.
#pragma once

#include <optional>

#include "navigation/contour/contour_check.h"
#include "tests/navigation/contour/rendered_bone.h"

namespace arthronaut::contour {

inline constexpr std::int64_t kBallFrame_ns = 1'000'000'000 / 15;

// The lens looks about; the bone lies where its marker and the registration say, but for `drift`.
class WatchedBall {
 public:
  explicit WatchedBall(const geometry::RigidTransform& registration_error = {})
      : check_(ball_mesh()), picture_(ball_mesh()) {
    check_.begin(registration_error);
  }
  const ContourVerdict& look(const geometry::RigidTransform& drift = {},
                             std::span<const Covered> covered = {}) {
    const geometry::RigidTransform camera_from_world = before_the_lens(0.08 * std::sin(0.06 * frames_));
    const camera::GrayView luma = picture_.draw(camera_from_world * drift);
    return check_.look(luma, picture_.camera(), camera_from_world, covered, ++frames_ * kBallFrame_ns);
  }
  void watch(double seconds, const geometry::RigidTransform& drift = {}) {
    for (int i = 0; i < 15 * seconds; ++i) (void)look(drift);
  }
  // Empty: not told.
  std::optional<double> told_after_s(const geometry::RigidTransform& drift) {
    for (int i = 1; i < 60; ++i)
      if (look(drift).state == ContourState::Drifted) return i / 15.0;
    return std::nullopt;
  }
  ContourCheck& check() { return check_; }
  RenderedBone& picture() { return picture_; }

 private:
  ContourCheck check_;
  RenderedBone picture_;
  std::int64_t frames_ = 0;
};

inline geometry::RigidTransform moved_by(const Eigen::Vector3d& by_mm) {
  return {Eigen::Quaterniond::Identity(), by_mm};
}

}  // namespace arthronaut::contour
