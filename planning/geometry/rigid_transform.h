// Rigid motions in mm. A value is always named target_from_source:
//   p_in_target = target_from_source * p_in_source,
//   target_from_source = target_from_middle * middle_from_source.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace arthronaut::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct RigidTransform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit norm
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point_in_source) const {
    return rotation * point_in_source + translation_mm;
  }
  [[nodiscard]] RigidTransform operator*(const RigidTransform& source_from_other) const {
    return {(rotation * source_from_other.rotation).normalized(), *this * source_from_other.translation_mm};
  }
  // Turns a direction; does not translate it.
  [[nodiscard]] Eigen::Vector3d rotate(const Eigen::Vector3d& direction) const {
    return rotation * direction;
  }
  [[nodiscard]] RigidTransform inverse() const {
    const Eigen::Quaterniond r = rotation.conjugate();
    return {r, -(r * translation_mm)};
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const { return rotation.toRotationMatrix(); }
};

// exp and log of SE(3). A twist is (v, w): translation in mm first, then rotation in rad. Perturbations act
// in the body frame, on the right: T <- T * exp(twist). log is valid for rotations below pi.
[[nodiscard]] RigidTransform exp(const Vector6d& twist);
[[nodiscard]] Vector6d log(const RigidTransform& transform);

// T * exp(d) = exp(adjoint(T) * d) * T. Layout [[R, [t]x R], [0, R]] for (v, w).
[[nodiscard]] Matrix6d adjoint(const RigidTransform& transform);

[[nodiscard]] Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);  // [v]x

// Angle in [0, pi]; atan2(|a x b|, a.b), which stays exact near 0 and pi.
[[nodiscard]] double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
[[nodiscard]] double rotation_angle_rad(const Eigen::Quaterniond& rotation);

inline constexpr double kPi = 3.14159265358979323846;
[[nodiscard]] constexpr double rad_from_deg(double deg) { return deg * kPi / 180.0; }
[[nodiscard]] constexpr double deg_from_rad(double rad) { return rad * 180.0 / kPi; }

}  // namespace arthronaut::geometry
