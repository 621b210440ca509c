// Pose of a few known points through the camera model, on raw distorted pixels. Inside the module; live
// tracking has its own solver in navigation/markers.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

struct PlanePose {
  geometry::RigidTransform camera_from_plane;
  double rms_px = 0;  // length of the reprojection errors
};

// Points of the plane z = 0 (four or more). Both poses that a plane may take are refined, the better one
// returned.
[[nodiscard]] std::optional<PlanePose> solve_plane_pose(std::span<const Eigen::Vector3d> points_mm,
                                                        std::span<const Eigen::Vector2d> pixels,
                                                        const camera::CameraModel& camera);

// Least squares from a start, any points.
[[nodiscard]] std::optional<PlanePose> refine_pose(std::span<const Eigen::Vector3d> points_mm,
                                                   std::span<const Eigen::Vector2d> pixels,
                                                   const camera::CameraModel& camera,
                                                   const geometry::RigidTransform& start);

}  // namespace arthronaut::calibration
