#include "navigation/calibration/plane_pose.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "navigation/calibration/conformal_map.h"

namespace arthronaut::calibration {
namespace {

using geometry::RigidTransform;

// Sum of squares, and for a body twist on the right the normal equations; nullopt when a point can't be seen.
std::optional<double> linearise(std::span<const Eigen::Vector3d> points,
                                std::span<const Eigen::Vector2d> pixels, const camera::CameraModel& camera,
                                const RigidTransform& pose, geometry::Matrix6d& normal,
                                geometry::Vector6d& right) {
  normal.setZero();
  right.setZero();
  double cost = 0;
  const Eigen::Matrix3d rotation = pose.matrix();
  for (std::size_t k = 0; k < points.size(); ++k) {
    Eigen::Matrix<double, 2, 3> slope;
    const auto pixel = camera.project(pose * points[k], slope);
    if (!pixel) return std::nullopt;
    const Eigen::Vector2d error = pixels[k] - *pixel;
    Eigen::Matrix<double, 2, 6> rows;
    rows << slope * rotation, -slope * rotation * geometry::cross_matrix(points[k]);
    normal += rows.transpose() * rows;
    right += rows.transpose() * error;
    cost += error.squaredNorm();
  }
  return cost;
}

// The other pose in which a small plane looks nearly alike: its normal mirrored about the line of sight.
RigidTransform mirrored(const RigidTransform& pose) {
  const Eigen::Vector3d sight = pose.translation_mm.normalized();
  const Eigen::Vector3d normal = pose.rotate(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d other = (2 * sight * sight.dot(normal) - normal).normalized();
  return {(Eigen::Quaterniond::FromTwoVectors(normal, other) * pose.rotation).normalized(),
          pose.translation_mm};
}

}  // namespace

std::optional<PlanePose> refine_pose(std::span<const Eigen::Vector3d> points_mm,
                                     std::span<const Eigen::Vector2d> pixels,
                                     const camera::CameraModel& camera, const RigidTransform& start) {
  RigidTransform pose = start;
  geometry::Matrix6d normal, trial_normal;
  geometry::Vector6d right, trial_right;
  auto cost = linearise(points_mm, pixels, camera, pose, normal, right);
  if (!cost) return std::nullopt;
  double damping = 1e-4;
  for (int pass = 0; pass < 40; ++pass) {
    geometry::Matrix6d damped = normal;
    damped.diagonal() *= 1 + damping;
    const geometry::Vector6d step = damped.ldlt().solve(right);
    if (!step.allFinite()) return std::nullopt;
    const RigidTransform trial = pose * geometry::exp(step);
    const auto trial_cost = linearise(points_mm, pixels, camera, trial, trial_normal, trial_right);
    if (trial_cost && *trial_cost <= *cost) {
      pose = trial;
      cost = trial_cost;
      normal = trial_normal;
      right = trial_right;
      damping = std::max(1e-9, damping / 10);
      if (step.norm() < 1e-9) break;
    } else if ((damping *= 10) > 1e6) {
      break;
    }
  }
  return PlanePose{pose, std::sqrt(*cost / static_cast<double>(points_mm.size()))};
}

std::optional<PlanePose> solve_plane_pose(std::span<const Eigen::Vector3d> points_mm,
                                          std::span<const Eigen::Vector2d> pixels,
                                          const camera::CameraModel& camera) {
  std::vector<Eigen::Vector2d> tangents, plane;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const auto tangent = camera.undistort(pixels[k]);
    if (!tangent) return std::nullopt;
    tangents.push_back(*tangent);
    plane.push_back(points_mm[k].head<2>());
  }
  const auto flat = camera_without_distortion(tangents, plane, Eigen::Vector2d::Zero());
  if (!flat) return std::nullopt;
  const auto first = refine_pose(points_mm, pixels, camera, pose_from_homography(flat->homography, 1.0));
  if (!first) return std::nullopt;
  const auto second = refine_pose(points_mm, pixels, camera, mirrored(first->camera_from_plane));
  return second && second->rms_px < first->rms_px ? second : first;
}

}  // namespace arthronaut::calibration
