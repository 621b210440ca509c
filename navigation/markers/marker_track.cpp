#include "navigation/markers/marker_track.h"

#include <algorithm>
#include <cmath>

#include "navigation/markers/verdict.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

// A smear up to which edges go on by themselves from where the marker stood, with so much less trust, where
// no direct fit confirms them.
constexpr double kLittleSmearPx = 8, kUnconfirmed = 10;
constexpr int kMaxPasses = 4;
// Through so much of a cell the edges of what turns back pass for sharp ones elsewhere.
constexpr double kTurnsBackCells = 0.6;
// Two starts that lead so near to each other lead to the same.
constexpr double kSameEdgesPx = 0.1, kSameMotionPx = 0.5;
// A search's start whose edges are not found by so much, along x and y together, leads nowhere.
constexpr double kMinStartShare = 1;
// Of small direct fits: what it costs to look at its edges.
constexpr int kEdgesAsFits = 2;
// How far what is smeared may be from where a motion puts it; how alike frame and smeared code have to be.
constexpr double kSmearedReachCells = 0.8, kMinSmearedScore = 0.75;
// From a start that was found so, the fit goes no farther, in cells.
constexpr double kSmearedWayCells = 2;
constexpr double kSoft = 1.4;
// What turns back while the shutter is open is smeared by a sigma of c / sqrt(720), and its edges are seen c
// / 24 beside where it is in the middle, for a change of its motion by c.
constexpr double kTurnedBesideSofter = 26.8 / 24;

}  // namespace

MarkerTrack::MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code,
                         const MarkerTrackOptions& options)
    : options_(options), marker_(marker), code_(code), cells_(code.cells), samples_(edge_samples(code)) {
  measurements_.reserve(samples_.size());
  few_.reserve(samples_.size());
  is_inlier_.reserve(samples_.size());
}

bool MarkerTrack::measure(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                          MarkerObservation& observation) {
  observation = MarkerObservation();
  observation.id = marker_.id;
  is_beyond_edges_ = false;
  seen_motion_.reset();
  const double cell = cell_px(frame, start);
  if (cell < options_.min_cell_px) {
    observation.state = MarkerState::TooSmall;
    return false;
  }
  if (is_found && is_undecided_) {
    observation.state = MarkerState::Doubtful;
    return false;
  }
  Smear picture;
  SmearTrend trend;
  const EdgePose fit = fit_edges(frame, start, is_found, picture, trend);
  frame.fits_left -= is_found ? kEdgesAsFits : 1;
  // Most starts that lead nowhere show it here, before what is dear.
  if (is_found && (!fit.converged || fit.share[0] + fit.share[1] < kMinStartShare)) {
    observation.state = reason_of_loss(start, measurements_, cell);
    return false;
  }
  // Both poses that the corners of a square allow, and several squares, often lead to one pose of its edges.
  const double px_per_mm = cell * cells_ / marker_.size_mm;
  const std::size_t refusals = is_found ? std::min(refused_count_, refused_.size()) : 0;
  for (const Refused& refused : std::span(refused_).first(refusals)) {
    const Vector6d apart = geometry::log(refused.edges.camera_from_marker.inverse() * fit.camera_from_marker);
    const Vector6d apart_moving = refused.motion - picture.motion;
    if (px_per_mm * (apart.head<3>().norm() + marker_.size_mm * apart.tail<3>().norm()) < kSameEdgesPx &&
        px_per_mm * apart_moving.head<3>().norm() < kSameMotionPx) {
      observation = refused.observation;
      return false;
    }
  }
  if (measure_from_edges(frame, start, is_found, fit, picture, trend, observation)) {
    // No hand turns it there: another tilt that the picture allows.
    if (stood_lately(frame) && !goes_on_from_published(frame, observation.camera_from_marker))
      observation.state = MarkerState::Doubtful;
    else if (is_identified(frame, picture, fit.converged ? misfit_of(fit) : 1, observation))
      return true;
  }
  // What explains the picture is known too badly through such a smear.
  if (is_beyond_edges_ && observation.state == MarkerState::Doubtful) observation.state = MarkerState::Blur;
  if (is_found) refused_[refused_count_++ % refused_.size()] = Refused{fit, picture.motion, observation};
  return false;
}

void MarkerTrack::suppose(const TrackedFrame& frame, const RigidTransform& start, bool is_calm) {
  if (!(start.translation_mm.z() > 0) || cell_px(frame, start) < options_.min_cell_px) return;
  Smear picture;
  SmearTrend trend;
  const EdgePose fit = fit_edges(frame, start, true, picture, trend);
  frame.fits_left -= kEdgesAsFits;
  if (!fit.converged || fit.share[0] + fit.share[1] < kMinStartShare) return;
  const double px_per_mm = cell_px(frame, fit.camera_from_marker) * cells_ / marker_.size_mm;
  if (!is_calm && moved_px(picture.motion, px_per_mm) > options_.smeared_px) return;
  MarkerObservation seen;
  report_edges(frame, fit, picture, true, seen);
  if (seen.is_tracked() && is_confirmed_by_code(frame, fit.camera_from_marker))
    go_on_from(fit.camera_from_marker, misfit_of(fit));
}

bool MarkerTrack::measure_from_edges(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                                     const EdgePose& fit, const Smear& picture, const SmearTrend& trend,
                                     MarkerObservation& observation) {
  const double cell = cell_px(frame, start);
  const double px_per_mm = cell * cells_ / marker_.size_mm;
  // Without a past nothing is known of the motion, and edges alone may take a smear for another tilt.
  const bool is_motion_known = !is_found && motion_.is_known_at(frame.timestamp_ns);
  // What turns back moves though it hardly got anywhere since the frame before.
  const RigidTransform& here = fit.converged ? fit.camera_from_marker : start;
  const Vector6d motion_now = frame.smear.exposure_share * interval_motion(frame, here);
  const bool turns_back = is_motion_known && moved_px(motion_now, px_per_mm) > kTurnsBackCells * cell &&
                          std::max(moved_px(motion_to(frame, here), px_per_mm),
                                   moved_px(picture.motion, px_per_mm)) < options_.smeared_px;
  const Vector6d& motion = turns_back ? motion_now : picture.motion;
  const double edges_motion_px = moved_px(motion, px_per_mm);
  // By so much it is smeared without a motion that is known: out of focus, or turning back.
  double softer_px = 0;
  if (frame.direct && (!is_motion_known || edges_motion_px > options_.smeared_px) &&
      cell > options_.min_direct_cell_px) {
    // Of what moves by more than a cell from frame to frame, and smeared so, few edges are found, or others.
    const bool moves_fast = is_motion_known && is_fast(frame, start);
    const bool has_edges = fit.converged && !(moves_fast && fit.share[0] + fit.share[1] < kMinStartShare);
    const RigidTransform& from = has_edges ? fit.camera_from_marker : start;
    // Without a fit left in this frame nothing is confirmed.
    DirectPose direct;
    is_undecided_ |= frame.fits_left <= 0 && !is_motion_known;
    if (frame.fits_left > 0)
      direct = fit_directly(frame, from, has_edges || !moves_fast ? motion : motion_to(frame, start),
                            has_edges ? options_.direct : unsure(options_.direct));
    if (has_edges && frame.fits_left > 0 && !direct.explains_picture()) {
      if (moves_fast)
        direct = fit_directly(frame, start, motion_to(frame, start), unsure(options_.direct));
      else if (is_found || turns_back)
        direct = fit_directly(frame, from, picture.motion, unsure(options_.direct));
    }
    // What moves may also pass for out of focus.
    if (!is_motion_known && (!direct.explains_picture() || direct.sigma_px > kSoft * frame.smear.sigma_px)) {
      // Where motions cannot be tried any more in this frame, nothing is known to be right.
      const bool may_try = frame.fits_left >= kFitsOfATrial;
      is_undecided_ |= !may_try;
      const DirectPose moving = may_try ? try_motions(frame, from) : DirectPose();
      if (!may_try || !direct.explains_picture() ||
          (moving.explains_picture() && moving.noise_grey < direct.noise_grey))
        direct = moving;
    }
    // With no edge pose to agree with, the corners have to be its own all the more.
    const EdgesBeside edges{fit, picture, is_found, edges_motion_px > options_.smeared_px,
                            fit.converged ? options_.max_direct_rms_px : options_.max_lone_rms_px};
    if (const auto stands = stand_by_direct(frame, start, direct, edges, observation)) return *stands;
    if (!is_motion_known && direct.is_usable())
      softer_px = std::sqrt(
          std::max(0.0, direct.sigma_px * direct.sigma_px - frame.smear.sigma_px * frame.smear.sigma_px));
  }
  if (!fit.converged) {
    observation.state = reason_of_loss(start, measurements_, cell);
    return false;
  }
  const RowTrend rows = report_edges(frame, fit, picture, is_found, observation);
  observation.covariance.topLeftCorner<2, 2>().diagonal().array() +=
      std::pow(kTurnedBesideSofter * softer_px / px_per_mm, 2);
  if (!observation.is_tracked()) return false;
  learn(trend, fit.bloom_px, frame.smear);
  frame.smear.rows.learn(rows);
  if (!is_found) {
    learn_exposure(motion_to(frame, fit.camera_from_marker), picture.motion, px_per_mm, frame.smear);
  }
  return true;
}

std::optional<bool> MarkerTrack::stand_by_direct(const TrackedFrame& frame, const RigidTransform& start,
                                                 const DirectPose& direct, const EdgesBeside& beside,
                                                 MarkerObservation& observation) {
  const EdgePose& fit = beside.fit;
  const bool is_found = beside.is_found;
  const double cell = cell_px(frame, start);
  const double px_per_mm = cell * cells_ / marker_.size_mm;
  const bool is_motion_known = !is_found && motion_.is_known_at(frame.timestamp_ns);
  RowTrend rows;
  const double smear_px = moved_px(direct.pose.velocity, px_per_mm);
  is_beyond_edges_ = smear_px > options_.max_new_smear_cells * cell;
  if (direct.is_usable()) {
    seen_motion_ = forwards(frame, direct.pose);
    report_direct(frame, direct, is_beyond_edges_ ? std::nullopt : std::optional(beside.max_rms_px),
                  observation);
    EdgePose edges;
    edges.camera_from_marker = direct.pose.camera_from_marker;
    rows = row_trend(frame.camera, marker_.size_mm, samples_, measurements_, is_inlier_, edges);
    doubt_rows(frame, rows, observation);
  }
  if (is_beyond_edges_ && direct.explains_picture()) {
    const bool goes_on = goes_on_from_published(frame, direct.pose.camera_from_marker);
    if (observation.is_tracked() && !goes_on) observation.state = MarkerState::Blur;
    // Good enough to go on from, not to stand for.
    if (observation.state == MarkerState::Blur || (!observation.is_tracked() && goes_on)) {
      go_on_from(direct.pose.camera_from_marker, 1 / (fit.converged ? fit.share[0] + fit.share[1] : 1));
      return false;
    }
  }
  const bool is_motion_new = is_found || is_motion_guessed_;
  if (observation.is_tracked() && is_motion_new && smear_px > options_.smeared_px) {
    if (const auto pose = refine_square_pose(frame.camera, observation.corners_px, marker_.size_mm,
                                             observation.camera_from_marker))
      observation.covariance += square_covariance(*pose, options_.found_corner_sigma_px);
  }
  if (observation.is_tracked()) {
    frame.smear.gamma += 0.1 * (direct.gamma - frame.smear.gamma);
    learn_share(frame, direct.pose);
  }
  const bool is_sharp = direct.explains_picture() && smear_px < options_.smeared_px;
  // What passes for out of focus may move: then the edges are of another tilt than the whole code. Through a
  // part of a cell they are still seen one by one: where they are of another tilt, the corners that they make
  // have to be the code's all the more.
  const bool has_loose_corners = direct.explains_picture() && observation.rms_px > options_.max_lone_rms_px &&
                                 smear_px < options_.max_edges_smear_cells * cell;
  if ((is_sharp || has_loose_corners) && fit.converged &&
      are_unlike(fit.camera_from_marker, direct.pose.camera_from_marker)) {
    observation.state = MarkerState::Doubtful;
    go_on_from(direct.pose.camera_from_marker, misfit_of(fit));
    return false;
  }
  if (is_found && is_undecided_) {
    observation.state = MarkerState::Doubtful;
    return false;
  }
  if (observation.is_tracked() && !(is_sharp && fit.converged)) {
    frame.smear.rows.learn(rows);
    return true;
  }
  if (!is_sharp) {
    if (!fit.converged) {
      observation.state = reason_of_loss(start, measurements_, cell);
      return false;
    }
    // Edges that the direct fit does not confirm are good enough to go on from, not to stand for.
    report_edges(frame, fit, beside.picture, is_found, observation);
    if (!observation.is_tracked()) return false;
    if (is_motion_known && moved_px(beside.picture.motion, px_per_mm) < kLittleSmearPx &&
        goes_on_from_published(frame, fit.camera_from_marker)) {
      observation.covariance *= kUnconfirmed;
      return true;
    }
    observation.state = beside.is_smeared ? MarkerState::Blur : MarkerState::Covered;
    go_on_from(fit.camera_from_marker, misfit_of(fit));
    return false;
  }
  return std::nullopt;
}

bool MarkerTrack::acquire(const TrackedFrame& frame, const Corners& square, int turn,
                          MarkerObservation& observation) {
  for (const RigidTransform& start : poses_of_square(square, turn, marker_.size_mm)) {
    if (start.translation_mm.z() > 0 && measure(frame, start, true, observation)) return true;
  }
  return false;
}

bool MarkerTrack::measure_smeared(const TrackedFrame& frame, const SquareSearch::SmallPicture& small,
                                  SmearSearch& search, std::span<const ExposedPose> motions,
                                  MarkerObservation& observation) {
  if (motions.empty()) return false;
  const double cell = cell_px(frame, motions.front().camera_from_marker);
  // The likeliest motion is of use to a direct fit alone.
  if (cell < options_.min_direct_cell_px || !frame.direct || frame.fits_left <= 0) return false;
  const double reach_px = kSmearedReachCells * cell;
  const SmearedPlace place = search.find(small, frame.camera, code_, marker_.size_mm,
                                         {frame.smear.sigma_px, frame.smear.gamma}, motions, reach_px);
  if (place.score < kMinSmearedScore) return false;
  const ExposedPose& start = place.exposed;
  observation = MarkerObservation();
  observation.id = marker_.id;
  is_beyond_edges_ = false;
  seen_motion_.reset();
  const RigidTransform& pose = start.camera_from_marker;
  if (cell_px(frame, pose) < options_.min_direct_cell_px) return false;
  DirectOptions near = options_.direct;
  near.max_way_cells = kSmearedWayCells;
  DirectPose direct = fit_directly(frame, pose, start.velocity, near, &start.change);
  if (!direct.explains_picture())
    direct = fit_directly(frame, pose, start.velocity, unsure(options_.direct), &start.change);
  if (!direct.explains_picture()) return false;
  const Smear picture{frame.smear.sigma_px, direct.pose.velocity};
  const EdgePose none;
  const EdgesBeside edges{none, picture, false, true, options_.max_direct_rms_px};
  if (!stand_by_direct(frame, pose, direct, edges, observation).value_or(false)) return false;
  if (stood_lately(frame) && !goes_on_from_published(frame, observation.camera_from_marker)) {
    observation.state = MarkerState::Doubtful;
    return false;
  }
  return is_identified(frame, picture, 1, observation);
}

void MarkerTrack::look_at_edges(const TrackedFrame& frame, const LinearImage& image,
                                const RigidTransform& pose, Smear picture, const ProfileOptions& options,
                                SmearTrend& trend) {
  picture.interval_motion = interval_motion(frame, pose);
  picture.between_fields = frame.smear.rows.known()[1];
  measure_edges(image, frame.camera, pose, marker_.size_mm, cells_, samples_, picture, options, measurements_,
                trend);
  if (const auto center = frame.camera.project(pose.translation_mm))
    correct_rows(frame.smear.rows, center->y(), frame.image.view().height, picture.sigma_px, measurements_);
}

EdgePose MarkerTrack::fit_edges(const TrackedFrame& frame, const RigidTransform& start, bool is_found,
                                Smear& picture, SmearTrend& trend) {
  const double cell = cell_px(frame, start);
  ProfileOptions coarse;
  coarse.search_px = edge_search_px(is_found, cell);
  coarse.stride = 2;
  const CameraSmear& smear = frame.smear;
  picture = {smear.sigma_px,
             is_found ? likely_motion(frame, start, coarse.search_px) : motion_to(frame, start)};
  look_at_edges(frame, frame.image, start, picture, coarse, trend);
  EdgePose fit =
      fit_edge_pose(frame.camera, marker_.size_mm, samples_, measurements_, start, smear.bloom, is_inlier_);
  if (!fit.converged || fit.share[0] + fit.share[1] < kMinEdgeShare) {
    fit.converged = false;
    return fit;
  }
  if (!is_found) picture.motion = motion_to(frame, fit.camera_from_marker);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const RigidTransform here = fit.camera_from_marker;
    look_at_edges(frame, frame.image, here, picture, {}, trend);
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
                                     const Vector6d& motion, const DirectOptions& options,
                                     const Vector6d* change) {
  frame.fits_left -= options.max_pixels < options_.direct.max_pixels ? 1 : kWholeFit;
  DirectStart from;
  from.pose = {start, motion, Vector6d::Zero()};
  from.sigma_px = frame.smear.sigma_px;
  from.gamma = frame.smear.gamma;
  from.delays = frame.smear.rows.known();
  from.interval_motion = interval_motion(frame, start);
  const double px_per_mm = frame.camera.central_focal_px() / start.translation_mm.z();
  const double motion_px = px_per_mm * motion.head<3>().norm();
  from.change_sigma_px = 2 + 0.35 * motion_px;
  from.velocity_sigma_px = 2 + 0.2 * motion_px;
  std::optional<Vector6d> known = change ? std::optional(*change) : std::nullopt;
  if (const auto by_way = motion_.change_to(start, frame.timestamp_ns, frame.interval_ns); by_way && !change)
    known = std::pow(frame.smear.exposure_share, 2) * *by_way;
  if (known) {
    from.pose.change = *known;
    from.change_sigma_px = 1.5 + 0.5 * px_per_mm * from.pose.change.head<3>().norm();
  }
  return frame.direct->refine(frame.image.view(), frame.camera, code_, samples_, marker_.size_mm, from,
                              options);
}

}  // namespace arthronaut::markers
