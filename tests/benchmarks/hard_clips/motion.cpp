#include "tests/benchmarks/hard_clips/motion.h"

#include <cmath>

#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::hard_clips {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

}  // namespace

Sway::Sway(Draw& draw, double speed_mm_s, double turn_rad_s, double reach_mm) {
  const double direction = draw.between(0, 2 * geometry::kPi);
  // The second sine is slower and larger: what is swayed about wanders.
  rate_[0] = speed_mm_s / reach_mm;
  rate_[1] = 0.37 * rate_[0];
  for (int k = 0; k < 2; ++k) {
    const double share = k == 0 ? 0.8 : 0.4;
    const double turned = direction + 1.3 * k;
    amplitude_[k] << share * reach_mm * std::cos(turned), share * reach_mm * std::sin(turned),
        draw.between(-0.4, 0.4) * share * reach_mm, draw.between(-0.03, 0.03) * reach_mm,
        draw.between(-0.03, 0.03) * reach_mm, share * turn_rad_s / rate_[0];
    for (int i = 0; i < 6; ++i) phase_[k][i] = i < 2 ? 0.4 * i : draw.between(0, 2 * geometry::kPi);
    // A hand cannot turn by more.
    amplitude_[k][5] = std::min(amplitude_[k][5], 0.5);
  }
}

Vector6d Sway::at(double time_s) const {
  Vector6d twist = Vector6d::Zero();
  for (int k = 0; k < 2; ++k)
    twist.array() += amplitude_[k].array() * (rate_[k] * time_s + phase_[k].array()).sin();
  return twist;
}

ClipMotion::ClipMotion(const ClipRecipe& recipe, const camera::CameraModel& camera) {
  Draw draw(recipe.seed * 7919 + 17 + 101 * static_cast<std::uint64_t>(recipe.hardness));
  distance_mm_ = recipe.distance_mm;
  const double px_per_mm = camera.central_focal_px() / recipe.distance_mm;
  const double exposure_s = recipe.exposure_share / recipe.frames_per_second;
  const double speed_mm_s = recipe.smear_px / exposure_s / px_per_mm;
  const double half_side_px = 0.5 * px_per_mm * recipe.marker_size_mm;
  const double turn_rad_s = recipe.turn_share * recipe.smear_px / half_side_px / exposure_s;
  scope_ = Sway(draw, 0.7 * speed_mm_s, turn_rad_s, draw.between(1, 2));
  const double first_turn = draw.between(0, 2 * geometry::kPi);
  for (int k = 0; k < kMarkers; ++k) {
    // In a triangle about the middle, so that none is in front of another.
    const double around = first_turn + k * 2 * geometry::kPi / 3;
    const double away = draw.between(0.8, 1.0) * 0.27 * recipe.distance_mm + 0.2 * recipe.marker_size_mm;
    const double tilt = draw.between(0.05, 0.8), tilt_to = draw.between(0, 2 * geometry::kPi);
    const Eigen::Quaterniond faces(Eigen::AngleAxisd(geometry::kPi, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond tilted(
        Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(tilt_to), std::sin(tilt_to), 0)));
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(draw.between(0, 2 * geometry::kPi), Eigen::Vector3d::UnitZ()));
    rest_[k] = {
        (tilted * faces * turned).normalized(),
        {away * std::cos(around), away * std::sin(around), recipe.distance_mm * draw.between(0.85, 1.15)}};
    // The world marker is fixed to the bone.
    if (k > 0) hands_[k] = Sway(draw, 0.3 * speed_mm_s, 0.3 * turn_rad_s, draw.between(0.5, 1.5));
  }
}

RigidTransform ClipMotion::camera_from_marker(int marker, double time_s) const {
  // The scope sways about what it looks at.
  const Eigen::Vector3d middle(0, 0, distance_mm_);
  const RigidTransform there{Eigen::Quaterniond::Identity(), middle};
  return there * geometry::exp(scope_.at(time_s)) * there.inverse() * rest_[marker] *
         geometry::exp(hands_[marker].at(time_s));
}

camera::Calibration calibration_of(const ClipRecipe& recipe) {
  camera::Calibration camera = simulator::standard_camera();
  const double scale = recipe.height / 1080.0;
  const auto scaled = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d((p.array() + 0.5) * scale - 0.5);
  };
  camera.image_size_px = {recipe.width, recipe.height};
  camera.focal_px *= scale;
  camera.principal_point_px = scaled(camera.principal_point_px);
  camera.rotation_center_px = scaled(camera.rotation_center_px);
  camera.boundary = {scaled(camera.boundary.center_px), scale * camera.boundary.radius_px};
  return camera;
}

camera::CameraModel camera_of(const ClipRecipe& recipe) {
  Draw draw(recipe.seed + 5);
  return {calibration_of(recipe), draw.between(-1, 1), 1.3345};
}

}  // namespace arthronaut::hard_clips
