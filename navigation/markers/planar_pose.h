// The pose of a square from its four corners, on raw pixels: both planar solutions in closed form, each
// refined on the distorted reprojection error. Pure mathematics; nothing is allocated.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

using Corners =
    std::array<Eigen::Vector2d, 4>;  // top-left, top-right, bottom-right, bottom-left of the marker

// The corners of a square of this side in its own frame, in the order of Corners (z = 0, y up).
[[nodiscard]] std::array<Eigen::Vector3d, 4> square_corners_mm(double size_mm);

// The homography that takes the marker plane (x, y in mm) to the tangent plane of the camera; H(2,2) = 1.
// nullopt when three of the corners are in line.
[[nodiscard]] std::optional<Eigen::Matrix3d> square_homography(const Corners& tangent, double size_mm);

// The two poses of a plane under a homography, the better first (Collins and Bartoli 2014). The homography
// maps the marker plane to the tangent plane, with the marker's centre in front of the camera. When the plane
// is seen head-on the two are alike.
[[nodiscard]] std::array<geometry::RigidTransform, 2> poses_from_homography(
    const Eigen::Matrix3d& homography);

// The same of a square of this side whose corners are these, the marker's top-left the one of index `turn`.
// Where there are none they are the camera's own place.
[[nodiscard]] std::array<geometry::RigidTransform, 2> poses_of_square(const Corners& tangent, int turn,
                                                                      double size_mm);

// The pose whose face is tilted the other way about the line of sight: near the other planar solution.
[[nodiscard]] geometry::RigidTransform tilted_back(const geometry::RigidTransform& camera_from_marker);

struct SquarePose {
  geometry::RigidTransform camera_from_marker;
  geometry::Matrix6d information = geometry::Matrix6d::Zero();  // J^T J in 1/px^2, body twist (v mm, w rad)
  double rms_px = 0;                                            // root mean square of the corners' distances
};

struct SquarePoses {
  SquarePose best;
  // The other minimum of the reprojection error; absent when both starts fall into the same one.
  std::optional<SquarePose> other;
  // rms of the other / rms of the best; kNoOtherPose without another.
  double ambiguity_ratio = 0;
};
inline constexpr double kNoOtherPose = 1e3;

// Minimises the reprojection error of the four corners in raw pixels by Levenberg-Marquardt. nullopt when a
// corner leaves the camera's field or the start is behind it.
[[nodiscard]] std::optional<SquarePose> refine_square_pose(const camera::CameraModel& camera,
                                                           const Corners& corners_px, double size_mm,
                                                           const geometry::RigidTransform& start);
// Both solutions, refined. nullopt when the corners are no square of this camera's.
[[nodiscard]] std::optional<SquarePoses> solve_square(const camera::CameraModel& camera,
                                                      const Corners& corners_px, double size_mm);

// Covariance of the body twist for this much error of a corner, one sigma in each direction.
[[nodiscard]] geometry::Matrix6d square_covariance(const SquarePose& pose, double sigma_px);

}  // namespace arthronaut::markers
