// One step of a pose towards what residuals ask of it. Twists (v, w) about a point near the touched area, in
// the bone frame: bone_from_marker <- twist * bone_from_marker.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::registration {

// How a residual (signed distance to the bone) grows with the twist.
inline geometry::Vector6d row_of(const Eigen::Vector3d& gradient, const Eigen::Vector3d& arm_mm) {
  geometry::Vector6d row;
  row << gradient, arm_mm.cross(gradient);
  return row;
}

struct NormalEquations {
  geometry::Matrix6d matrix = geometry::Matrix6d::Zero();  // what lies above the diagonal is not looked at
  geometry::Vector6d right = geometry::Vector6d::Zero();

  void add(const geometry::Vector6d& row, double residual_mm, double weight) {
    // By pairs of rows, since these few products are most of the time of a fit.
    const geometry::Vector6d weighted = weight * row;
    matrix.col(0) += weighted[0] * row;
    matrix.col(1) += weighted[1] * row;
    matrix.col(2).tail<4>() += weighted[2] * row.tail<4>();
    matrix.col(3).tail<4>() += weighted[3] * row.tail<4>();
    matrix.col(4).tail<2>() += weighted[4] * row.tail<2>();
    matrix.col(5).tail<2>() += weighted[5] * row.tail<2>();
    right -= weighted * residual_mm;
  }

  // Slightly damped, so that a motion which nothing holds stays where it is; steps are kept within reason.
  [[nodiscard]] geometry::Vector6d solve() const {
    constexpr double kMaxTranslation_mm = 3.0, kMaxAngle_rad = 0.2;
    geometry::Matrix6d damped = matrix.selfadjointView<Eigen::Lower>();
    damped.diagonal().array() *= 1.0 + 1e-6;
    damped.diagonal().array() += 1e-6;
    geometry::Vector6d twist = damped.ldlt().solve(right);
    const double excess =
        std::max(twist.head<3>().norm() / kMaxTranslation_mm, twist.tail<3>().norm() / kMaxAngle_rad);
    if (excess > 1) twist /= excess;
    return twist.allFinite() ? twist : geometry::Vector6d::Zero();
  }
};

inline void move(geometry::RigidTransform& bone_from_marker, const geometry::Vector6d& twist,
                 const Eigen::Vector3d& pivot_mm) {
  const Eigen::Vector3d w = twist.tail<3>();
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0) turn = Eigen::AngleAxisd(angle, w / angle);
  bone_from_marker.rotation = (turn * bone_from_marker.rotation).normalized();
  bone_from_marker.translation_mm =
      turn * (bone_from_marker.translation_mm - pivot_mm) + pivot_mm + twist.head<3>();
}

}  // namespace arthronaut::registration
