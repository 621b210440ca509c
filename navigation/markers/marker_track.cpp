#include "navigation/markers/marker_track.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr std::int64_t kForgetNs = 400'000'000;
// Two sightings farther apart than this say nothing about the motion now.
constexpr std::int64_t kMotionNs = 70'000'000;

constexpr double kMinShare = 0.3;  // of the edges crossed along x, and along y
constexpr double kMinMeanShare = 0.42;
constexpr double kMaxScale = 8;  // residuals / their predicted sigmas
constexpr double kMaxRmsPx = 1.2;
// A marker that comes from nowhere must be seen nearly whole: there is no motion to agree with.
constexpr double kMinNewShare = 0.7;
// Motions over the exposure that are tried when none is known.
constexpr double kTriedLengthsPx[] = {7, 14};
constexpr int kTriedDirections = 4;
constexpr double kMaxSigmaMm = 0.25, kMaxSigmaRad = 1.5 * geometry::kPi / 180;
constexpr int kMaxPasses = 4;
constexpr double kMaxNewMotionPx = 5;
// At first sight the motion is a guess: so much more may be wrong with each corner.
constexpr double kFoundCornerSigmaPx = 0.15;
// How far the edges are looked for, in cells; less than half, or the next edge answers.
constexpr double kReachPredicted = 0.35, kReachFound = 0.45;
constexpr double kMinCellPx = 3;
constexpr double kMinFacing = 0.2;  // cosine of the face's normal to the line of sight: 78 degrees
constexpr double kCornerSigmaPx = 0.05;
constexpr double kMinAmbiguityRatio = 2, kHarmlessFlipRad = 3 * geometry::kPi / 180;

double facing(const RigidTransform& pose) {
  return -pose.rotate(Eigen::Vector3d::UnitZ()).dot(pose.translation_mm.normalized());
}

// A motion in the image plane at the marker's depth, as a body twist.
Vector6d twist_of(const Eigen::Vector2d& motion_px, const camera::CameraModel& camera,
                  const RigidTransform& pose) {
  const double mm_per_px = pose.translation_mm.z() / camera.central_focal_px();
  Vector6d twist = Vector6d::Zero();
  twist.head<3>() =
      pose.rotation.conjugate() * Eigen::Vector3d(mm_per_px * motion_px.x(), mm_per_px * motion_px.y(), 0);
  return twist;
}

// How the profiles want the motion changed, in pixels; nothing when they hardly tell.
Eigen::Vector2d motion_step(const SmearTrend& trend) {
  const double total = trend.motion_weight.trace();
  if (total < 0.05) return Eigen::Vector2d::Zero();
  const Eigen::Matrix2d damped = trend.motion_weight + 0.02 * total * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d step = damped.inverse() * trend.motion_gain;
  return step * std::min(1.0, 4 / std::max(step.norm(), 1e-9));
}

double cell_px(const camera::CameraModel& camera, const RigidTransform& pose, double size_mm, int cells) {
  return camera.central_focal_px() * size_mm / cells / std::max(pose.translation_mm.z(), 1.0);
}

// From a motion that was worth some pixels.
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

}  // namespace

MarkerTrack::MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code)
    : marker_(marker), cells_(code.cells), samples_(edge_samples(code)) {
  measurements_.reserve(samples_.size());
  is_inlier_.reserve(samples_.size());
}

std::optional<RigidTransform> MarkerTrack::predicted(std::int64_t timestamp_ns) const {
  if (!last_ || timestamp_ns - last_->timestamp_ns > kForgetNs || timestamp_ns < last_->timestamp_ns)
    return std::nullopt;
  const std::int64_t step = before_ ? last_->timestamp_ns - before_->timestamp_ns : 0;
  if (step <= 0 || step > kMotionNs || timestamp_ns - last_->timestamp_ns > kMotionNs)
    return last_->camera_from_marker;
  const Vector6d twist = geometry::log(before_->camera_from_marker.inverse() * last_->camera_from_marker);
  const double share = static_cast<double>(timestamp_ns - last_->timestamp_ns) / static_cast<double>(step);
  return last_->camera_from_marker * geometry::exp(share * twist);
}

Vector6d MarkerTrack::twist_to(const RigidTransform& pose, std::int64_t timestamp_ns) const {
  if (!last_ || timestamp_ns <= last_->timestamp_ns || timestamp_ns - last_->timestamp_ns > kMotionNs) {
    return Vector6d::Zero();
  }
  return geometry::log(last_->camera_from_marker.inverse() * pose);
}

bool MarkerTrack::measure(const LinearImage& image, const camera::CameraModel& camera,
                          const RigidTransform& start, bool is_found, std::int64_t timestamp_ns,
                          CameraSmear& smear, MarkerObservation& observation) {
  observation = MarkerObservation();
  observation.id = marker_.id;
  const double cell = cell_px(camera, start, marker_.size_mm, cells_);
  if (cell < kMinCellPx) {
    observation.state = MarkerState::TooSmall;
    return false;
  }
  SmearTrend trend;
  ProfileOptions coarse;
  coarse.search_px =
      std::clamp(static_cast<int>(std::lround((is_found ? kReachFound : kReachPredicted) * cell)), 2, 16);
  coarse.stride = 2;
  Smear picture{smear.sigma_px, is_found ? likely_motion(image, camera, start, coarse.search_px, smear)
                                         : Vector6d(smear.exposure_share * twist_to(start, timestamp_ns))};
  measure_edges(image, camera, start, marker_.size_mm, cells_, samples_, picture, coarse, measurements_,
                trend);
  EdgePose fit =
      fit_edge_pose(camera, marker_.size_mm, samples_, measurements_, start, smear.bloom, is_inlier_);
  if (!fit.converged || fit.share[0] + fit.share[1] < kMinShare) {
    observation.state = reason_of_loss(camera, start);
    return false;
  }
  if (!is_found) picture.motion = smear.exposure_share * twist_to(fit.camera_from_marker, timestamp_ns);
  const Vector6d expected_motion = picture.motion;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const RigidTransform here = fit.camera_from_marker;
    measure_edges(image, camera, here, marker_.size_mm, cells_, samples_, picture, {}, measurements_, trend);
    fit = fit_edge_pose(camera, marker_.size_mm, samples_, measurements_, here, smear.bloom, is_inlier_);
    if (!fit.converged) {
      observation.state = reason_of_loss(camera, here);
      return false;
    }
    const Eigen::Vector2d longer = motion_step(trend);
    picture.motion += twist_of(longer, camera, fit.camera_from_marker);
    const double moved = geometry::log(here.inverse() * fit.camera_from_marker).head<3>().norm();
    if (moved * cell * cells_ / marker_.size_mm < 0.5 && longer.norm() < 0.7) break;
  }

  observation.camera_from_marker = fit.camera_from_marker;
  observation.covariance = fit.covariance;
  const MeasuredCorners corners =
      measured_corners(camera, marker_.size_mm, samples_, measurements_, is_inlier_, fit);
  observation.corners_px = corners.corners_px;
  observation.rms_px = corners.rms_px;
  std::optional<SquarePose> other;
  observation.ambiguity_ratio = kNoOtherPose;
  if (const auto poses = solve_square(camera, corners.corners_px, marker_.size_mm)) {
    other = poses->other;
    if (other) {
      observation.ambiguity_ratio =
          std::min(kNoOtherPose, other->rms_px / std::max(observation.rms_px, kCornerSigmaPx));
    }
    if (is_found) observation.covariance += square_covariance(poses->best, kFoundCornerSigmaPx);
  }
  observation.state = judge(fit, observation, other, is_found);
  if (observation.state == MarkerState::Covered)
    observation.state = reason_of_loss(camera, fit.camera_from_marker);
  // A first sight through a strong smear is good enough to go on from, not to stand for.
  if (is_found && observation.is_tracked() &&
      picture.motion.head<3>().norm() * cell * cells_ > kMaxNewMotionPx * marker_.size_mm) {
    observation.state = MarkerState::Blur;
    follow_from(observation, timestamp_ns);
  }
  if (!observation.is_tracked()) return false;
  learn(trend, fit.bloom_px, smear);
  if (!is_found) learn_exposure(expected_motion, picture.motion, cell * cells_ / marker_.size_mm, smear);
  return true;
}

Vector6d MarkerTrack::likely_motion(const LinearImage& image, const camera::CameraModel& camera,
                                    const RigidTransform& pose, int search_px, const CameraSmear& smear) {
  ProfileOptions sparse;
  sparse.search_px = search_px;
  sparse.stride = 4;
  SmearTrend ignored;
  const auto likeness = [&](const Vector6d& motion) {
    measure_edges(image, camera, pose, marker_.size_mm, cells_, samples_, {smear.sigma_px, motion}, sparse,
                  measurements_, ignored);
    double sum = 0;
    for (const EdgeMeasurement& measurement : measurements_) sum += std::max(0.0, measurement.likeness - 0.5);
    return sum;
  };
  Vector6d best = Vector6d::Zero();
  double most = likeness(best);
  if (most > 0.47 * static_cast<double>(measurements_.size())) return best;  // sharp
  for (const double length : kTriedLengthsPx) {
    for (int direction = 0; direction < kTriedDirections; ++direction) {
      const double angle = geometry::kPi * direction / kTriedDirections;
      const Vector6d motion = twist_of({length * std::cos(angle), length * std::sin(angle)}, camera, pose);
      const double sum = likeness(motion);
      if (sum > most) {
        most = sum;
        best = motion;
      }
    }
  }
  return best;
}

MarkerState MarkerTrack::judge(const EdgePose& fit, const MarkerObservation& observation,
                               const std::optional<SquarePose>& other, bool is_found) const {
  if (is_found && std::min(fit.share[0], fit.share[1]) < kMinNewShare) return MarkerState::Covered;
  if (std::min(fit.share[0], fit.share[1]) < kMinShare || fit.share[0] + fit.share[1] < 2 * kMinMeanShare) {
    return MarkerState::Covered;
  }
  if (facing(fit.camera_from_marker) < kMinFacing) return MarkerState::TooOblique;
  const double sigma_mm = std::sqrt(fit.covariance.topLeftCorner<3, 3>().trace());
  const double sigma_rad = std::sqrt(fit.covariance.bottomRightCorner<3, 3>().trace());
  if (fit.scale > kMaxScale || observation.rms_px > kMaxRmsPx || !(sigma_mm < kMaxSigmaMm) ||
      !(sigma_rad < kMaxSigmaRad)) {
    return MarkerState::Doubtful;
  }
  if (other && observation.ambiguity_ratio < kMinAmbiguityRatio &&
      geometry::rotation_angle_rad(fit.camera_from_marker.rotation.conjugate() *
                                   other->camera_from_marker.rotation) > kHarmlessFlipRad) {
    return MarkerState::Ambiguous;
  }
  return MarkerState::Tracked;
}

// By what most of the edges that are missing at the supposed pose look like.
MarkerState MarkerTrack::reason_of_loss(const camera::CameraModel& camera, const RigidTransform& pose) const {
  int out = 0, saturated = 0, total = 0;
  double box = 0;
  for (const EdgeMeasurement& measurement : measurements_) {
    ++total;
    out += measurement.state == EdgeState::OutOfView;
    saturated += measurement.state == EdgeState::Saturated;
    box = std::max(box, measurement.box_px);
  }
  if (total == 0) return MarkerState::NotSeen;
  if (out > 0.25 * total) return MarkerState::OutOfView;
  if (facing(pose) < kMinFacing) return MarkerState::TooOblique;
  if (saturated > 0.2 * total) return MarkerState::Glare;
  if (box > 0.8 * cell_px(camera, pose, marker_.size_mm, cells_)) return MarkerState::Blur;
  return MarkerState::Covered;
}

void MarkerTrack::follow(const MarkerObservation& observation, std::int64_t timestamp_ns) {
  const bool is_measured = observation.is_tracked() || observation.state == MarkerState::Ambiguous ||
                           observation.state == MarkerState::Duplicate;
  if (!is_measured) return;
  follow_from(observation, timestamp_ns);
}

void MarkerTrack::follow_from(const MarkerObservation& observation, std::int64_t timestamp_ns) {
  before_ = last_;
  last_ = Sighting{observation.camera_from_marker, timestamp_ns};
}

void MarkerTrack::forget() {
  last_.reset();
  before_.reset();
  is_duplicate = false;
}

}  // namespace arthronaut::markers
