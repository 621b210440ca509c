#include "navigation/markers/marker_track.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "navigation/markers/verdict.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

// Motions over the exposure that are tried when none is known.
constexpr double kTriedLengthsPx[] = {8, 18};
constexpr int kTriedDirections = 4;
// A smear up to which edges go on by themselves, with so much less trust, where no direct fit confirms them.
constexpr double kLittleSmearPx = 8, kUnconfirmed = 10;
constexpr int kMaxPasses = 4;
constexpr double kMaxNewMotionPx = 5;
// How far the edges are looked for, in cells; less than half, or the next edge answers.
constexpr double kReachPredicted = 0.35, kReachFound = 0.45;
// Two starts that lead so near to each other lead to the same.
constexpr double kSameEdgesPx = 0.1, kSameMotionPx = 0.5;
constexpr double kSoft = 1.4;

// From a start that may be off by a third of a cell, and over a longer way.
DirectOptions unsure(DirectOptions options) {
  options.coarse_cells = 0.3;
  options.max_way_cells = 3;
  return options;
}

// Quick: which of many motions is worth a whole fit.
DirectOptions tried(DirectOptions options) {
  options = unsure(options);
  options.max_iterations = 5;
  options.max_pixels = 300;
  return options;
}

double cell_px(const camera::CameraModel& camera, const RigidTransform& pose, double size_mm, int cells) {
  return camera.central_focal_px() * size_mm / cells / std::max(pose.translation_mm.z(), 1.0);
}

}  // namespace

MarkerTrack::MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code,
                         const MarkerTrackOptions& options)
    : options_(options), marker_(marker), code_(code), cells_(code.cells), samples_(edge_samples(code)) {
  measurements_.reserve(samples_.size());
  is_inlier_.reserve(samples_.size());
}

bool MarkerTrack::measure(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                          MarkerObservation& observation) {
  observation = MarkerObservation();
  observation.id = marker_.id;
  const double cell = cell_px(frame.camera, start, marker_.size_mm, cells_);
  if (cell < options_.min_cell_px) {
    observation.state = MarkerState::TooSmall;
    return false;
  }
  Smear picture;
  SmearTrend trend;
  const EdgePose fit = fit_edges(frame, start, is_found, picture, trend);
  // Both poses that the corners of a square allow often lead to one pose of its edges.
  if (is_found && fit.converged && refused_) {
    const double px_per_mm = cell * cells_ / marker_.size_mm;
    const Vector6d apart =
        geometry::log(refused_->edges.camera_from_marker.inverse() * fit.camera_from_marker);
    const Vector6d apart_moving = refused_->motion - picture.motion;
    if (px_per_mm * (apart.head<3>().norm() + marker_.size_mm * apart.tail<3>().norm()) < kSameEdgesPx &&
        px_per_mm * apart_moving.head<3>().norm() < kSameMotionPx) {
      observation = refused_->observation;
      return false;
    }
  }
  if (measure_from_edges(frame, start, is_found, fit, picture, trend, observation)) return true;
  if (is_found && fit.converged) refused_ = Refused{fit, picture.motion, observation};
  return false;
}

bool MarkerTrack::measure_from_edges(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                                     const EdgePose& fit, const Smear& picture, const SmearTrend& trend,
                                     MarkerObservation& observation) {
  const double cell = cell_px(frame.camera, start, marker_.size_mm, cells_);
  const double px_per_mm = cell * cells_ / marker_.size_mm;
  // Without a past nothing is known of the motion, and edges alone may take a smear for another tilt.
  const bool is_motion_known = !is_found && motion_.is_known_at(frame.timestamp_ns);
  const double edges_motion_px = picture.motion.head<3>().norm() * px_per_mm;
  if (frame.direct && (!is_motion_known || edges_motion_px > options_.smeared_px) &&
      cell > options_.min_direct_cell_px) {
    const RigidTransform& from = fit.converged ? fit.camera_from_marker : start;
    DirectPose direct =
        fit_directly(frame, from, picture.motion, fit.converged ? options_.direct : unsure(options_.direct));
    if (is_found && fit.converged && !direct.explains_picture())
      direct = fit_directly(frame, from, picture.motion, unsure(options_.direct));
    // What moves may also pass for out of focus.
    if (!is_motion_known && (!direct.explains_picture() || direct.sigma_px > kSoft * frame.smear.sigma_px)) {
      const DirectPose moving = try_motions(frame, from);
      if (!direct.explains_picture() || (moving.explains_picture() && moving.noise_grey < direct.noise_grey))
        direct = moving;
    }
    // With no edge pose to agree with, the corners have to be its own all the more.
    if (direct.is_usable())
      report_direct(frame, direct, fit.converged ? options_.max_direct_rms_px : options_.max_lone_rms_px,
                    observation);
    if (observation.is_tracked()) {
      frame.smear.gamma += 0.1 * (direct.gamma - frame.smear.gamma);
      learn_exposure(
          frame.smear.exposure_share * motion_.twist_to(direct.pose.camera_from_marker, frame.timestamp_ns),
          direct.pose.velocity, px_per_mm, frame.smear);
    }
    const bool is_sharp =
        direct.explains_picture() && direct.pose.velocity.head<3>().norm() * px_per_mm < options_.smeared_px;
    if (observation.is_tracked() && !(is_sharp && fit.converged)) return true;
    if (!is_sharp) {
      if (!fit.converged) {
        observation.state = reason_of_loss(start, measurements_, cell);
        return false;
      }
      // Edges that the direct fit does not confirm are good enough to go on from, not to stand for.
      report_edges(frame, fit, picture, is_found, observation);
      if (!observation.is_tracked()) return false;
      if (is_motion_known && edges_motion_px < kLittleSmearPx) {
        observation.covariance *= kUnconfirmed;
        return true;
      }
      observation.state = edges_motion_px > options_.smeared_px ? MarkerState::Blur : MarkerState::Covered;
      go_on_from(fit);
      return false;
    }
  }
  if (!fit.converged) {
    observation.state = reason_of_loss(start, measurements_, cell);
    return false;
  }
  report_edges(frame, fit, picture, is_found, observation);
  if (!observation.is_tracked()) return false;
  learn(trend, fit.bloom_px, frame.smear);
  if (!is_found) {
    learn_exposure(frame.smear.exposure_share * motion_.twist_to(fit.camera_from_marker, frame.timestamp_ns),
                   picture.motion, px_per_mm, frame.smear);
  }
  return true;
}

EdgePose MarkerTrack::fit_edges(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                                Smear& picture, SmearTrend& trend) {
  const double cell = cell_px(frame.camera, start, marker_.size_mm, cells_);
  ProfileOptions coarse;
  coarse.search_px =
      std::clamp(static_cast<int>(std::lround((is_found ? kReachFound : kReachPredicted) * cell)), 2, 16);
  coarse.stride = 2;
  const CameraSmear& smear = frame.smear;
  picture = {smear.sigma_px,
             is_found ? likely_motion(frame, start, coarse.search_px)
                      : Vector6d(smear.exposure_share * motion_.twist_to(start, frame.timestamp_ns))};
  measure_edges(frame.image, frame.camera, start, marker_.size_mm, cells_, samples_, picture, coarse,
                measurements_, trend);
  EdgePose fit =
      fit_edge_pose(frame.camera, marker_.size_mm, samples_, measurements_, start, smear.bloom, is_inlier_);
  if (!fit.converged || fit.share[0] + fit.share[1] < kMinEdgeShare) {
    fit.converged = false;
    return fit;
  }
  if (!is_found)
    picture.motion = smear.exposure_share * motion_.twist_to(fit.camera_from_marker, frame.timestamp_ns);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const RigidTransform here = fit.camera_from_marker;
    measure_edges(frame.image, frame.camera, here, marker_.size_mm, cells_, samples_, picture, {},
                  measurements_, trend);
    fit =
        fit_edge_pose(frame.camera, marker_.size_mm, samples_, measurements_, here, smear.bloom, is_inlier_);
    if (!fit.converged) break;
    const Eigen::Vector2d longer = motion_step(trend);
    picture.motion += twist_of(longer, frame.camera, fit.camera_from_marker);
    const double moved = geometry::log(here.inverse() * fit.camera_from_marker).head<3>().norm();
    if (moved * cell * cells_ / marker_.size_mm < 0.5 && longer.norm() < 0.7) break;
  }
  return fit;
}

DirectPose MarkerTrack::fit_directly(const TrackedFrame& frame, const RigidTransform& start,
                                     const Vector6d& motion, const DirectOptions& options) {
  DirectStart from;
  from.pose = {start, motion, Vector6d::Zero()};
  from.sigma_px = frame.smear.sigma_px;
  from.gamma = frame.smear.gamma;
  const double px_per_mm = frame.camera.central_focal_px() / start.translation_mm.z();
  const double motion_px = px_per_mm * motion.head<3>().norm();
  from.change_sigma_px = 2 + 0.35 * motion_px;
  from.velocity_sigma_px = 2 + 0.2 * motion_px;
  if (const auto change = motion_.change_to(start, frame.timestamp_ns)) {
    from.pose.change = std::pow(frame.smear.exposure_share, 2) * *change;
    from.change_sigma_px = 1.5 + 0.5 * px_per_mm * from.pose.change.head<3>().norm();
  }
  return frame.direct->refine(frame.image.view(), frame.camera, code_, samples_, marker_.size_mm, from,
                              options);
}

DirectPose MarkerTrack::try_motions(const TrackedFrame& frame, const RigidTransform& start) {
  DirectPose best;
  for (const double length : kTriedLengthsPx) {
    for (int direction = 0; direction < kTriedDirections; ++direction) {
      const double angle = geometry::kPi * direction / kTriedDirections;
      const Vector6d motion =
          twist_of({length * std::cos(angle), length * std::sin(angle)}, frame.camera, start);
      const DirectPose fit = fit_directly(frame, start, motion, tried(options_.direct));
      if (!fit.is_usable() || (best.is_usable() && fit.noise_grey >= best.noise_grey)) continue;
      best = fit;
    }
  }
  if (!best.is_usable()) return best;
  DirectOptions whole = options_.direct;
  whole.max_way_cells = 2;
  return fit_directly(frame, best.pose.camera_from_marker, best.pose.velocity, whole);
}

void MarkerTrack::report_direct(const TrackedFrame& frame, const DirectPose& fit, double max_rms_px,
                                MarkerObservation& observation) {
  observation.camera_from_marker = fit.pose.camera_from_marker;
  observation.covariance = fit.covariance;
  // The motion is not followed in all six directions: what is left out changes about as much as what is seen.
  const double ratio = fit.pose.change.head<2>().norm() / std::max(1e-6, fit.pose.velocity.head<2>().norm());
  const Vector6d left_out = std::clamp(ratio, 0.4, 4.0) / 24 * fit.pose.velocity;
  observation.covariance.diagonal() += left_out.cwiseAbs2();
  // The corners as the edges by themselves would have them.
  SmearTrend ignored;
  measure_edges(frame.image, frame.camera, fit.pose.camera_from_marker, marker_.size_mm, cells_, samples_,
                {frame.smear.sigma_px, fit.pose.velocity}, {}, measurements_, ignored);
  is_inlier_.resize(measurements_.size());
  for (std::size_t i = 0; i < measurements_.size(); ++i)
    is_inlier_[i] =
        measurements_[i].state == EdgeState::Found && std::abs(measurements_[i].offset_px) < kMaxEdgeRmsPx;
  EdgePose edges;
  edges.camera_from_marker = fit.pose.camera_from_marker;
  edges.bloom_px = frame.smear.bloom.mean_px;
  const MeasuredCorners corners =
      measured_corners(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, edges);
  observation.corners_px = corners.corners_px;
  observation.rms_px = corners.rms_px;
  observation.ambiguity_ratio = kNoOtherPose;
  observation.state = judge(fit, max_rms_px, observation);
  if (observation.is_tracked() && explained_ && are_unlike(*explained_, fit.pose.camera_from_marker))
    observation.state = MarkerState::Doubtful;
  if (!observation.is_tracked() && fit.explains_picture()) explained_ = fit.pose.camera_from_marker;
  // The other pose that has nearly these corners must be told apart by how the picture looks there.
  Corners exact;
  const auto corners_mm = square_corners_mm(marker_.size_mm);
  for (int k = 0; k < 4; ++k) {
    const auto corner = frame.camera.project(fit.pose.camera_from_marker * corners_mm[k]);
    if (!corner) return;
    exact[k] = *corner;
  }
  const auto poses = solve_square(frame.camera, exact, marker_.size_mm);
  if (!observation.is_tracked() || !poses || !poses->other) return;
  const double corner_px = std::hypot(
      options_.corner_sigma_px, std::sqrt((poses->best.information * observation.covariance).trace() / 8));
  observation.ambiguity_ratio = std::min(kNoOtherPose, poses->other->rms_px / corner_px);
  if (observation.ambiguity_ratio >= options_.clear_ratio) return;
  const DirectPose other =
      fit_directly(frame, poses->other->camera_from_marker, fit.pose.velocity, options_.direct);
  if (!other.is_usable() || other.noise_grey > options_.other_noise * fit.noise_grey) return;
  if (are_unlike(fit.pose.camera_from_marker, other.pose.camera_from_marker))
    observation.state = MarkerState::Ambiguous;
}

void MarkerTrack::report_edges(const TrackedFrame& frame, const EdgePose& fit, const Smear& picture,
                               bool is_found, MarkerObservation& observation) {
  observation.camera_from_marker = fit.camera_from_marker;
  observation.covariance = fit.covariance;
  const MeasuredCorners corners =
      measured_corners(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, fit);
  observation.corners_px = corners.corners_px;
  observation.rms_px = corners.rms_px;
  std::optional<SquarePose> other;
  bool is_contradicted = false;
  observation.ambiguity_ratio = kNoOtherPose;
  if (const auto poses = solve_square(frame.camera, corners.corners_px, marker_.size_mm)) {
    other = poses->other;
    // The edges settled on one tilt, the corners that they make speak for the other one.
    is_contradicted = are_unlike(fit.camera_from_marker, poses->best.camera_from_marker);
    if (other) {
      observation.ambiguity_ratio =
          std::min(kNoOtherPose, other->rms_px / std::max(observation.rms_px, options_.corner_sigma_px));
    }
    if (is_found) observation.covariance += square_covariance(poses->best, options_.found_corner_sigma_px);
  }
  observation.state = judge(fit, observation, other, is_found);
  if (observation.is_tracked() && is_contradicted) observation.state = MarkerState::Doubtful;
  if (observation.is_tracked() &&
      may_be_tilted_back(frame.camera, marker_.size_mm, samples_, measurements_, fit, corners.corners_px,
                         frame.smear.bloom, is_inlier_)) {
    observation.state = MarkerState::Ambiguous;
  }
  const double cell = cell_px(frame.camera, fit.camera_from_marker, marker_.size_mm, cells_);
  if (observation.state == MarkerState::Covered)
    observation.state = reason_of_loss(fit.camera_from_marker, measurements_, cell);
  // A first sight through a strong smear is good enough to go on from, not to stand for.
  if (is_found && observation.is_tracked() &&
      picture.motion.head<3>().norm() * cell * cells_ > kMaxNewMotionPx * marker_.size_mm) {
    observation.state = MarkerState::Blur;
    go_on_from(fit);
  }
}

Vector6d MarkerTrack::likely_motion(const TrackedFrame& frame, const RigidTransform& pose, int search_px) {
  ProfileOptions sparse;
  sparse.search_px = search_px;
  sparse.stride = 4;
  SmearTrend ignored;
  const auto likeness = [&](const Vector6d& motion) {
    measure_edges(frame.image, frame.camera, pose, marker_.size_mm, cells_, samples_,
                  {frame.smear.sigma_px, motion}, sparse, measurements_, ignored);
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
      const Vector6d motion =
          twist_of({length * std::cos(angle), length * std::sin(angle)}, frame.camera, pose);
      const double sum = likeness(motion);
      if (sum > most) {
        most = sum;
        best = motion;
      }
    }
  }
  return best;
}

void MarkerTrack::go_on_from(const EdgePose& fit) {
  const double misfit = std::max(1.0, fit.scale) / (fit.share[0] + fit.share[1]);
  if (!guess_ || misfit < guess_->misfit) guess_ = Guess{fit.camera_from_marker, misfit};
}

void MarkerTrack::follow(const MarkerObservation& observation, std::int64_t timestamp_ns) {
  const bool is_measured = observation.is_tracked() || observation.state == MarkerState::Ambiguous ||
                           observation.state == MarkerState::Duplicate;
  if (is_measured)
    motion_.follow(observation.camera_from_marker, timestamp_ns);
  else if (guess_)
    motion_.follow(guess_->camera_from_marker, timestamp_ns);
  guess_.reset();
  refused_.reset();
  explained_.reset();
}

void MarkerTrack::forget() {
  motion_ = MarkerMotion();
  guess_.reset();
  refused_.reset();
  explained_.reset();
  is_duplicate = false;
}

}  // namespace arthronaut::markers
