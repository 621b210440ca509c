#include "navigation/markers/camera_smear.h"

#include <Eigen/LU>
#include <algorithm>

namespace arthronaut::markers {

using geometry::Vector6d;

Vector6d twist_of(const Eigen::Vector2d& motion_px, const camera::CameraModel& camera,
                  const geometry::RigidTransform& pose) {
  const double mm_per_px = pose.translation_mm.z() / camera.central_focal_px();
  Vector6d twist = Vector6d::Zero();
  twist.head<3>() =
      pose.rotation.conjugate() * Eigen::Vector3d(mm_per_px * motion_px.x(), mm_per_px * motion_px.y(), 0);
  return twist;
}

Eigen::Vector2d motion_step(const SmearTrend& trend) {
  const double total = trend.motion_weight.trace();
  if (total < 0.05) return Eigen::Vector2d::Zero();
  const Eigen::Matrix2d damped = trend.motion_weight + 0.02 * total * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d step = damped.inverse() * trend.motion_gain;
  return step * std::min(1.0, 4 / std::max(step.norm(), 1e-9));
}

void learn_exposure(const Vector6d& expected, const Vector6d& found, double px_per_mm, CameraSmear& smear) {
  const double square = expected.head<3>().squaredNorm();
  if (square * px_per_mm * px_per_mm < 9) return;
  const double ratio = std::clamp(found.head<3>().dot(expected.head<3>()) / square, 0.5, 1.5);
  smear.exposure_share = std::clamp(smear.exposure_share * (1 + 0.2 * (ratio - 1)), 0.02, 1.0);
}

void learn(const SmearTrend& trend, double bloom_px, CameraSmear& smear) {
  smear.bloom.mean_px += 0.1 * (bloom_px - smear.bloom.mean_px);
  if (trend.sigma_weight > 1) {
    smear.sigma_px = std::clamp(smear.sigma_px + 0.2 * trend.sigma_gain / trend.sigma_weight, 0.5, 3.0);
  }
}

}  // namespace arthronaut::markers
