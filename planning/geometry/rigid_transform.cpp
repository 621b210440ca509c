#include "planning/geometry/rigid_transform.h"

#include <cmath>

namespace arthronaut::geometry {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

namespace {

// V of SE(3): the translation of exp(v, w) is V(w) v.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d k = cross_matrix(w);
  // Series below 1e-4 rad: the closed forms lose digits there, the dropped terms are under 1e-18.
  const double a = angle < 1e-4 ? 0.5 - angle2 / 24 : (1 - std::cos(angle)) / angle2;
  const double b = angle < 1e-4 ? 1.0 / 6 - angle2 / 120 : (angle - std::sin(angle)) / (angle2 * angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

}  // namespace

RigidTransform exp(const Vector6d& twist) {
  const Eigen::Vector3d w = twist.tail<3>();
  const double half = 0.5 * w.norm();
  const double sinc = half < 1e-6 ? 0.5 - half * half / 12 : std::sin(half) / (2 * half);
  const Eigen::Vector3d xyz = sinc * w;
  return {Eigen::Quaterniond(std::cos(half), xyz.x(), xyz.y(), xyz.z()).normalized(),
          left_jacobian(w) * twist.head<3>()};
}

Vector6d log(const RigidTransform& transform) {
  Eigen::Quaterniond q = transform.rotation;
  if (q.w() < 0) q.coeffs() *= -1;
  const double sine = q.vec().norm();
  const double angle = 2 * std::atan2(sine, q.w());
  const Eigen::Vector3d w =
      sine < 1e-9 ? Eigen::Vector3d(2 * q.vec()) : Eigen::Vector3d(q.vec() * (angle / sine));
  Vector6d twist;
  twist << left_jacobian(w).inverse() * transform.translation_mm, w;
  return twist;
}

Matrix6d adjoint(const RigidTransform& transform) {
  const Eigen::Matrix3d r = transform.matrix();
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = r;
  ad.topRightCorner<3, 3>() = cross_matrix(transform.translation_mm) * r;
  ad.bottomRightCorner<3, 3>() = r;
  return ad;
}

double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double rotation_angle_rad(const Eigen::Quaterniond& rotation) {
  return 2 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

}  // namespace arthronaut::geometry
