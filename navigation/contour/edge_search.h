// What the picture shows across a piece of the bone's outline: how strong an edge stands how far along its
// normal, whichever side is the brighter.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/contour/visible_bone.h"

namespace arthronaut::contour {

inline constexpr double kStep_mm = 0.1;  // along the normal, at the outline's depth
inline constexpr int kSteps = 25;        // to each side
inline constexpr int kPlaces = 2 * kSteps + 1;

// Part of the picture where no bone can be seen: a disc swept from a to b. Pixels.
struct Covered {
  Eigen::Vector2d a_px = Eigen::Vector2d::Zero(), b_px = Eigen::Vector2d::Zero();
  double radius_px = 0;
};

// Within the picture and the view, 8 px from its rim, and nothing before it that is known.
[[nodiscard]] bool is_free(const camera::CameraModel& camera, std::span<const Covered> covered,
                           const Eigen::Vector2d& at_px);

// Edge strength by place, from -kSteps to kSteps steps outwards: 0 to 1, 1 for the strongest of a profile
// that shows a clear edge at all; its mean taken away, so that a profile that tells nothing is zero all
// along.
struct EdgeProfile {
  std::array<float, kPlaces> strength{};
  Eigen::Vector3f normal_in_bone = Eigen::Vector3f::UnitZ();
};

// nullopt: a part of it is out of the view, covered, blown out or too dark to tell. Allocates nothing.
[[nodiscard]] std::optional<EdgeProfile> edge_profile(const camera::GrayView& luma,
                                                      const camera::CameraModel& camera,
                                                      const geometry::RigidTransform& camera_from_bone,
                                                      const ContourPoint& point,
                                                      std::span<const Covered> covered);

}  // namespace arthronaut::contour
