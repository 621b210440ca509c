// What a track says of a pose that was measured: how well it is known, and whether it stands.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "navigation/markers/marker_track.h"
#include "navigation/markers/verdict.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kMaxNewMotionPx = 5;
// So many times the noise at which the other pose is out of the question, and its fit is given up that would
// not get below by the end: residuals may yet fall faster.
constexpr double kHopeless = 1.5;
// A pose tilted the other way whose edges scatter by less than this share of the fit's is the right one.
constexpr double kMuchBetter = 0.5;
// Where fewer edges are found, in the mean of both ways, they scatter by less than this, in their predicted
// sigmas, and the cells agree; or some are of what covers the marker.
constexpr double kManyEdges = 0.75, kMaxPartScale = 2;
// Or the marker goes on to where it was going, they scatter by no more than is predicted, and of the inner
// cells this many agree, and so many times those that say the opposite: what covers hides cells, too.
constexpr double kPredictedScale = 1;
constexpr int kMinCellsOfPart = 5, kMostCells = 2;
// Where fewer are, something hides or bends a part: one half has to hold the pose by itself.
constexpr double kNearlyAllEdges = 0.9;
// How well it is known how a marker moves now: by two sightings in the mean of the way between them, of which
// a hand changes so much; by three as that changes evenly, but for so much of the change.
constexpr double kUnknownOfMotion = 0.25, kUnknownOfChange = 0.125;

}  // namespace

void MarkerTrack::doubt_rows(const TrackedFrame& frame, const RowTrend& trend,
                             MarkerObservation& observation) const {
  const RowTiming& rows = frame.smear.rows;
  const auto& twists = trend.twist_by_delays;
  observation.covariance += twists * rows.uncertainty() * twists.transpose();
  const RigidTransform& pose = observation.camera_from_marker;
  const auto change = motion_.change_to(pose, frame.timestamp_ns, frame.interval_ns);
  const double px_per_mm = cell_px(frame, pose) * cells_ / marker_.size_mm;
  const double moves_px = px_per_mm * interval_motion(frame, pose).head<3>().norm();
  const double change_px = change ? px_per_mm * change->head<3>().norm() : 0;
  const double motion_sigma_px = change ? kUnknownOfChange * change_px : kUnknownOfMotion * moves_px;
  observation.covariance += rows.uncertainty()(0, 0) * motion_sigma_px * motion_sigma_px *
                            trend.twist_by_motion * trend.twist_by_motion.transpose();
  const double comb_px = rows.comb_px(moves_px, change_px);
  if (!(comb_px > 0)) return;
  if (const auto square = refine_square_pose(frame.camera, observation.corners_px, marker_.size_mm, pose))
    observation.covariance += square_covariance(*square, comb_px);
}

void MarkerTrack::report_direct(const TrackedFrame& frame, const DirectPose& fit,
                                std::optional<double> max_rms_px, MarkerObservation& observation) {
  observation.camera_from_marker = fit.pose.camera_from_marker;
  observation.covariance = fit.covariance;
  // The motion is not followed in all six directions: what is left out changes about as much as what is seen.
  const double ratio = fit.pose.change.head<2>().norm() / std::max(1e-6, fit.pose.velocity.head<2>().norm());
  const Vector6d left_out = std::clamp(ratio, 0.4, 4.0) / 24 * fit.pose.velocity;
  observation.covariance.diagonal() += left_out.cwiseAbs2();
  // The corners as the edges by themselves would have them. A smeared edge is a ramp, which another tone
  // curve bends: it is looked at in the light that the fit found. And it lies where it was in the mean, which
  // is not in the middle of the time where the motion changes.
  const RigidTransform& pose = fit.pose.camera_from_marker;
  const double px_per_mm = cell_px(frame, pose) * cells_ / marker_.size_mm;
  const bool is_smeared = moved_px(fit.pose.velocity, px_per_mm) > options_.smeared_px;
  const Smear picture{frame.smear.sigma_px, fit.pose.velocity};
  SmearTrend ignored;
  if (!is_smeared) {
    look_at_edges(frame, frame.image, pose, picture, {}, ignored);
  } else {
    const LinearTable light(fit.gamma);
    const RigidTransform mean = pose * geometry::exp(1.0 / 24 * fit.pose.change);
    look_at_edges(frame, LinearImage(frame.image.view(), light), mean, picture, {}, ignored);
    for (EdgeMeasurement& measurement : measurements_) {
      const EdgeSample& sample = samples_[measurement.sample];
      const Eigen::Vector3d place(sample.x * marker_.size_mm, sample.y * marker_.size_mm, 0);
      const auto there = frame.camera.project(pose * place), in_mean = frame.camera.project(mean * place);
      if (there && in_mean) measurement.point_px += *there - *in_mean;
    }
  }
  is_inlier_.resize(measurements_.size());
  for (std::size_t i = 0; i < measurements_.size(); ++i)
    is_inlier_[i] =
        measurements_[i].state == EdgeState::Found && std::abs(measurements_[i].offset_px) < kMaxEdgeRmsPx;
  EdgePose edges;
  edges.camera_from_marker = pose;
  edges.bloom_px = is_smeared ? 0 : frame.smear.bloom.mean_px;
  const MeasuredCorners corners =
      measured_corners(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, edges);
  observation.corners_px = corners.corners_px;
  observation.rms_px = corners.rms_px;
  observation.ambiguity_ratio = kNoOtherPose;
  if (!max_rms_px) {
    const double unfollowed_px = options_.unfollowed_share * moved_px(fit.pose.velocity, px_per_mm);
    if (const auto square = refine_square_pose(frame.camera, corners.corners_px, marker_.size_mm,
                                               fit.pose.camera_from_marker))
      observation.covariance += square_covariance(*square, unfollowed_px);
    observation.rms_px = std::max(observation.rms_px, unfollowed_px);
  }
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
  // Where nothing was known before, the motion is this fit's, and the other pose has its own.
  const bool goes_on = goes_on_from_published(frame, fit.pose.camera_from_marker);
  DirectOptions by_noise = goes_on ? options_.direct : unsure(options_.direct);
  const double most_noise_grey = options_.other_noise * fit.noise_grey;
  by_noise.hopeless_noise_grey = std::min(by_noise.hopeless_noise_grey, kHopeless * most_noise_grey);
  const DirectPose other = fit_directly(frame, poses->other->camera_from_marker, fit.pose.velocity, by_noise);
  if (!other.is_usable() || other.noise_grey > most_noise_grey) return;
  if (are_unlike(fit.pose.camera_from_marker, other.pose.camera_from_marker))
    observation.state = MarkerState::Ambiguous;
}

bool MarkerTrack::are_few_edges_its_own(const TrackedFrame& frame, const EdgePose& fit, bool is_found) const {
  if (fit.scale >= kMaxPartScale) return false;
  const RigidTransform& pose = fit.camera_from_marker;
  const SeenCode code = seen_code(frame, pose);
  if (code.is_confirmed()) return true;
  return !is_found && fit.scale < kPredictedScale && stood_lately(frame) && goes_on_to(frame, pose) &&
         code.agreeing_inside >= std::max(kMinCellsOfPart, kMostCells * code.opposite_inside);
}

RowTrend MarkerTrack::report_edges(const TrackedFrame& frame, const EdgePose& fit, const Smear& picture,
                                   bool is_found, MarkerObservation& observation) {
  observation.camera_from_marker = fit.camera_from_marker;
  observation.covariance = fit.covariance;
  const MeasuredCorners corners =
      measured_corners(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, fit);
  observation.corners_px = corners.corners_px;
  observation.rms_px = corners.rms_px;
  const RowTrend rows = row_trend(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, fit);
  doubt_rows(frame, rows, observation);
  std::optional<SquarePose> other;
  std::optional<RigidTransform> by_corners;  // where that is another tilt
  observation.ambiguity_ratio = kNoOtherPose;
  if (const auto poses = solve_square(frame.camera, corners.corners_px, marker_.size_mm)) {
    other = poses->other;
    if (are_unlike(fit.camera_from_marker, poses->best.camera_from_marker))
      by_corners = poses->best.camera_from_marker;
    if (other) {
      observation.ambiguity_ratio =
          std::min(kNoOtherPose, other->rms_px / std::max(observation.rms_px, options_.corner_sigma_px));
    }
    // After a guess as little is known of the motion as at first sight; and where the sides of
    // a marker that moves do not meet in the pose's corners, it moves in a way that is not known.
    const double moved_px =
        picture.motion.head<3>().norm() * cell_px(frame, fit.camera_from_marker) * cells_ / marker_.size_mm;
    const bool tells_by_corners = moved_px > 0.5 * options_.smeared_px &&
                                  std::min(fit.share[0], fit.share[1]) > options_.nearly_whole_share;
    const double sigma_px =
        std::hypot(is_found || is_motion_guessed_ ? options_.found_corner_sigma_px : 0,
                   tells_by_corners ? 2 * std::max(0.0, corners.rms_px - options_.usual_corner_rms_px) : 0);
    observation.covariance += square_covariance(poses->best, sigma_px);
  }
  if (const auto change = motion_.change_to(fit.camera_from_marker, frame.timestamp_ns, frame.interval_ns)) {
    const double share = options_.change_share * std::pow(frame.smear.exposure_share, 2);
    observation.covariance += share * share * *change * change->transpose();
  }
  observation.state = judge(fit, observation, other, is_found);
  // Seen in part for the first time: what its cells say takes the place of the edges that are missing.
  if (is_found && observation.state == MarkerState::Covered &&
      is_confirmed_by_code(frame, fit.camera_from_marker))
    observation.state = judge(fit, observation, other, false);
  // The outline of what lies before a marker passes for the edges that it hides.
  if (observation.is_tracked() && fit.share[0] + fit.share[1] < 2 * kManyEdges &&
      !are_few_edges_its_own(frame, fit, is_found))
    observation.state = MarkerState::Covered;
  // The edges settled on one tilt, the corners that they make speak for another one, and from there the edges
  // do not come back: corners that glow or dirt moved are unlike the edges, too, where tilt is seen badly.
  if (observation.is_tracked() && by_corners) {
    const EdgePose there = fit_edge_pose(frame.camera, marker_.size_mm, samples_, measurements_, *by_corners,
                                         frame.smear.bloom, is_inlier_);
    if (!there.converged || are_unlike(fit.camera_from_marker, there.camera_from_marker))
      observation.state = MarkerState::Doubtful;
  }
  if (observation.is_tracked()) {
    const auto rival = rival_tilt(frame.camera, marker_.size_mm, samples_, measurements_, fit,
                                  corners.corners_px, frame.smear.bloom, is_inlier_);
    if (rival) observation.state = MarkerState::Ambiguous;
    if (rival && rival->scale < kMuchBetter * fit.scale) {
      observation.state = MarkerState::Doubtful;  // what is ambiguous is gone on from
      go_on_from(rival->camera_from_marker, misfit_of(*rival));
    }
  }
  if (observation.is_tracked() && fit.share[0] + fit.share[1] < 2 * kNearlyAllEdges) {
    const auto doubt = doubt_by_halves(frame.camera, marker_.size_mm, samples_, measurements_, fit,
                                       frame.smear.bloom, few_, is_inlier_);
    if (doubt) observation.covariance += *doubt;
    if (!doubt) observation.state = MarkerState::Doubtful;
  }
  const double cell = cell_px(frame, fit.camera_from_marker);
  if (observation.state == MarkerState::Covered)
    observation.state = reason_of_loss(fit.camera_from_marker, measurements_, cell);
  // A first sight through a strong smear is good enough to go on from, not to stand for.
  if (is_found && observation.is_tracked() &&
      picture.motion.head<3>().norm() * cell * cells_ > kMaxNewMotionPx * marker_.size_mm) {
    observation.state = MarkerState::Blur;
    go_on_from(fit.camera_from_marker, misfit_of(fit));
  }
  return rows;
}

}  // namespace arthronaut::markers
