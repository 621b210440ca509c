#include "navigation/guidance/registration_bias.h"

#include <Eigen/Cholesky>

namespace arthronaut::guidance {

void BiasSums::add(const TipSensitivity& point, double weight) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(point.tip_mm);
  normal_ += weight * move.transpose() * move;
  camera_ += weight * move.transpose() * point.per_camera_error;
  tip_ += weight * move.transpose() * point.per_tip_error;
  weight_ += weight;
}

BiasSums& BiasSums::operator+=(const BiasSums& other) {
  normal_ += other.normal_;
  camera_ += other.camera_;
  tip_ += other.tip_;
  weight_ += other.weight_;
  return *this;
}

RegistrationBias BiasSums::bias() const {
  RegistrationBias bias;
  bias.per_tip_error.topRows<3>().setIdentity();
  if (empty()) return bias;
  // About the points' own centre c, with v = v_c + [c]x w: the sums hold it as weight * [c]x.
  Eigen::Matrix<double, 6, 6> from_centered = Eigen::Matrix<double, 6, 6>::Identity();
  from_centered.topRightCorner<3, 3>() = normal_.bottomLeftCorner<3, 3>() / weight_;
  geometry::Matrix6d centered = from_centered.transpose() * normal_ * from_centered;
  // Points on one line leave the turn about it open; a spread of 0.1 mm decides whether it follows.
  centered.bottomRightCorner<3, 3>() += 0.01 * weight_ * Eigen::Matrix3d::Identity();
  const Eigen::LDLT<geometry::Matrix6d> solver(centered);
  bias.per_camera_error = from_centered * solver.solve(from_centered.transpose() * camera_);
  bias.per_tip_error = from_centered * solver.solve(from_centered.transpose() * tip_);
  return bias;
}

}  // namespace arthronaut::guidance
