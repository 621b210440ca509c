#include "navigation/markers/verdict.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr double kMinMeanShare = 0.42;
constexpr double kMaxScale = 8;  // residuals / their predicted sigmas
// A marker that comes from nowhere must be seen nearly whole: there is no motion to agree with.
constexpr double kMinNewShare = 0.7;
constexpr double kMaxSigmaMm = 0.25, kMaxSigmaRad = 1.5 * geometry::kPi / 180;
constexpr double kMinFacing = 0.2;  // cosine of the face's normal to the line of sight: 78 degrees
constexpr double kMinAmbiguityRatio = 2;
// A start that was measured in this frame is not measured again: so near, by its distance, and turned so far.
constexpr double kSameStart = 0.001, kSameStartRad = 0.02;

double facing(const RigidTransform& pose) {
  return -pose.rotate(Eigen::Vector3d::UnitZ()).dot(pose.translation_mm.normalized());
}

}  // namespace

bool are_unlike(const RigidTransform& a, const RigidTransform& b) {
  return geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation) > kHarmlessTiltRad;
}

bool are_alike(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation_mm - b.translation_mm).norm() < kSameStart * a.translation_mm.norm() &&
         geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation) < kSameStartRad;
}

bool is_known_well_enough(const geometry::Matrix6d& covariance) {
  return std::sqrt(covariance.topLeftCorner<3, 3>().trace()) < kMaxSigmaMm &&
         std::sqrt(covariance.bottomRightCorner<3, 3>().trace()) < kMaxSigmaRad;
}

MarkerState judge(const DirectPose& fit, std::optional<double> max_rms_px,
                  const MarkerObservation& observation) {
  if (facing(fit.pose.camera_from_marker) < kMinFacing) return MarkerState::TooOblique;
  const double sigma_mm = std::sqrt(observation.covariance.topLeftCorner<3, 3>().trace());
  const double sigma_rad = std::sqrt(observation.covariance.bottomRightCorner<3, 3>().trace());
  // Exactly 0: no side of the square was seen by edges, so nothing confirms the corners.
  const bool is_confirmed = !max_rms_px || (observation.rms_px > 0 && observation.rms_px < *max_rms_px);
  if (!fit.explains_picture() || !is_confirmed || !(sigma_mm < kMaxSigmaMm) || !(sigma_rad < kMaxSigmaRad))
    return MarkerState::Doubtful;
  return MarkerState::Tracked;
}

MarkerState judge(const EdgePose& fit, const MarkerObservation& observation,
                  const std::optional<SquarePose>& other, bool is_found) {
  if (is_found && std::min(fit.share[0], fit.share[1]) < kMinNewShare) return MarkerState::Covered;
  if (std::min(fit.share[0], fit.share[1]) < kMinEdgeShare ||
      fit.share[0] + fit.share[1] < 2 * kMinMeanShare) {
    return MarkerState::Covered;
  }
  if (facing(fit.camera_from_marker) < kMinFacing) return MarkerState::TooOblique;
  const double sigma_mm = std::sqrt(fit.covariance.topLeftCorner<3, 3>().trace());
  const double sigma_rad = std::sqrt(fit.covariance.bottomRightCorner<3, 3>().trace());
  if (fit.scale > kMaxScale || observation.rms_px > kMaxEdgeRmsPx || !(sigma_mm < kMaxSigmaMm) ||
      !(sigma_rad < kMaxSigmaRad)) {
    return MarkerState::Doubtful;
  }
  if (other && observation.ambiguity_ratio < kMinAmbiguityRatio &&
      are_unlike(fit.camera_from_marker, other->camera_from_marker))
    return MarkerState::Ambiguous;
  return MarkerState::Tracked;
}

MarkerState reason_of_loss(const RigidTransform& pose, std::span<const EdgeMeasurement> measurements,
                           double cell_px) {
  int out = 0, saturated = 0, total = 0;
  double box = 0;
  for (const EdgeMeasurement& measurement : measurements) {
    ++total;
    out += measurement.state == EdgeState::OutOfView;
    saturated += measurement.state == EdgeState::Saturated;
    box = std::max(box, measurement.box_px);
  }
  if (total == 0) return MarkerState::NotSeen;
  if (out > 0.25 * total) return MarkerState::OutOfView;
  if (facing(pose) < kMinFacing) return MarkerState::TooOblique;
  if (saturated > 0.2 * total) return MarkerState::Glare;
  if (box > 0.8 * cell_px) return MarkerState::Blur;
  return MarkerState::Covered;
}

}  // namespace arthronaut::markers
