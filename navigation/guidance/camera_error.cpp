#include "navigation/guidance/camera_error.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>

namespace arthronaut::guidance {

std::optional<TwistPerCameraError> twist_per_camera_error(const geometry::RigidTransform& camera_from_marker,
                                                          double size_mm, const camera::CameraModel& camera) {
  const double half_mm = size_mm / 2;
  const std::array<Eigen::Vector3d, 4> corners_mm{
      Eigen::Vector3d(-half_mm, -half_mm, 0), Eigen::Vector3d(-half_mm, half_mm, 0),
      Eigen::Vector3d(half_mm, -half_mm, 0), Eigen::Vector3d(half_mm, half_mm, 0)};
  return twist_per_camera_error(camera_from_marker, corners_mm, camera);
}

std::optional<TwistPerCameraError> twist_per_camera_error(const geometry::RigidTransform& camera_from_body,
                                                          std::span<const Eigen::Vector3d> corners_mm,
                                                          const camera::CameraModel& camera) {
  // The principal point follows c = q + R (c0 - q): by R and I - R, wherever the two lie.
  Eigen::Matrix<double, 4, 6> lens = Eigen::Matrix<double, 4, 6>::Zero();
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(camera.lens_angle_rad()).toRotationMatrix();
  lens(0, 0) = lens(1, 1) = 1;
  lens.block<2, 2>(2, 2) = turn;
  lens.block<2, 2>(2, 4) = Eigen::Matrix2d::Identity() - turn;

  const Eigen::Matrix3d rotation = camera_from_body.matrix();
  geometry::Matrix6d normal = geometry::Matrix6d::Zero();
  TwistPerCameraError right = TwistPerCameraError::Zero();
  for (const Eigen::Vector3d& corner : corners_mm) {
    const Eigen::Vector3d in_camera = camera_from_body * corner;
    Eigen::Matrix<double, 2, 3> d_pixel_d_point;
    const auto pixel = camera.project(in_camera, d_pixel_d_point);
    const auto d_pixel_d_lens = camera.d_pixel_d_lens(in_camera);
    if (!pixel || !d_pixel_d_lens) return std::nullopt;
    Eigen::Matrix<double, 3, 6> d_point_d_twist;
    d_point_d_twist << rotation, -rotation * geometry::cross_matrix(corner);
    const Eigen::Matrix<double, 2, 6> d_pixel_d_twist = d_pixel_d_point * d_point_d_twist;
    normal += d_pixel_d_twist.transpose() * d_pixel_d_twist;
    right += d_pixel_d_twist.transpose() * (*d_pixel_d_lens * lens);
  }
  // The corners stay where they were seen: what the camera moves, the pose takes back.
  // LDLT solves what is singular, too, and leaves out what it cannot tell: of fewer than three corners, say.
  constexpr double kRounding = 1e-12;
  const Eigen::LDLT<geometry::Matrix6d> solver(normal);
  const geometry::Vector6d pivots = solver.vectorD();
  if (solver.info() != Eigen::Success || !(pivots.minCoeff() > kRounding * pivots.maxCoeff()))
    return std::nullopt;
  const TwistPerCameraError result = -solver.solve(right);
  if (!result.allFinite()) return std::nullopt;
  return result;
}

}  // namespace arthronaut::guidance
