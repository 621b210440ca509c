// What a track takes from frame to frame, and how it comes back after a loss.
#include <algorithm>
#include <cmath>

#include "navigation/markers/marker_track.h"

namespace arthronaut::markers {

using geometry::RigidTransform;

SeenCode MarkerTrack::seen_code(const TrackedFrame& frame, const RigidTransform& pose) const {
  for (std::size_t i = 0; i < frame.codes.declared.size(); ++i) {
    if (frame.codes.declared[i].id == code_.id)
      return see_code(frame.image, frame.camera, pose, marker_.size_mm, frame.codes, i);
  }
  return {};
}

bool MarkerTrack::goes_on_to(const TrackedFrame& frame, const RigidTransform& pose) const {
  constexpr double kMostSides = 0.5, kMostTurnRad = 0.6;
  if (!motion_.is_known_at(frame.timestamp_ns)) return false;
  const auto supposed = motion_.predicted(frame.timestamp_ns);
  if (!supposed) return false;
  const double apart = (pose.translation_mm.normalized() - supposed->translation_mm.normalized()).norm();
  return apart * pose.translation_mm.norm() < kMostSides * marker_.size_mm &&
         geometry::rotation_angle_rad(supposed->rotation.conjugate() * pose.rotation) < kMostTurnRad;
}

bool MarkerTrack::is_identified(const TrackedFrame& frame, const Smear& picture, double misfit,
                                MarkerObservation& observation) {
  const RigidTransform& pose = observation.camera_from_marker;
  if (!goes_on_to(frame, pose)) {
    is_sure_ = false;
    evidence_.start_over();
  }
  if (is_sure_) return true;
  is_sure_ = !evidence_.add(frame.image, frame.camera, pose, marker_.size_mm, code_, picture);
  if (is_sure_) return true;
  const auto declared = std::find_if(frame.codes.declared.begin(), frame.codes.declared.end(),
                                     [&](const MarkerCode& code) { return code.id == code_.id; });
  const double lead = evidence_.lead(frame.codes, declared - frame.codes.declared.begin());
  is_sure_ = lead >= options_.sure_lead;
  if (is_sure_) return true;
  observation.state = MarkerState::Glare;
  if (lead > -options_.sure_lead) go_on_from(pose, misfit);
  return false;
}

bool MarkerTrack::measure_recovered(const TrackedFrame& frame, const RigidTransform& start,
                                    MarkerObservation& observation) {
  const bool is_found = !motion_.is_known_at(frame.timestamp_ns);
  if (!measure(frame, start, is_found, observation)) return false;
  // It is not where it was going to, so that its motion is known no better than at first sight.
  const auto square = refine_square_pose(frame.camera, observation.corners_px, marker_.size_mm,
                                         observation.camera_from_marker);
  if (square && !is_found)
    observation.covariance += square_covariance(*square, options_.found_corner_sigma_px);
  // Through such a smear the fit to the whole code takes the place of its cells.
  if (is_beyond_edges_ || is_confirmed_by_code(frame, observation.camera_from_marker)) return true;
  observation.state = MarkerState::Doubtful;
  return false;
}

bool MarkerTrack::stood_lately(const TrackedFrame& frame) const {
  constexpr std::int64_t kShortWhileNs = 70'000'000;
  return published_ && frame.timestamp_ns - published_->timestamp_ns <= kShortWhileNs;
}

bool MarkerTrack::goes_on_from_published(const TrackedFrame& frame, const RigidTransform& pose) const {
  if (!stood_lately(frame)) return false;
  const double passed_s = 1e-9 * static_cast<double>(frame.timestamp_ns - published_->timestamp_ns);
  // What turns about the line of sight is seen to do so, however fast.
  const Eigen::Quaterniond turn = pose.rotation * published_->camera_from_marker.rotation.conjugate();
  const double about_sight = turn.vec().dot(pose.translation_mm.normalized());
  const double turned_rad = 2 * std::acos(std::min(1.0, std::hypot(turn.w(), about_sight)));
  return turned_rad <= options_.turn_slack_rad + options_.max_turn_rad_s * passed_s;
}

void MarkerTrack::go_on_from(const RigidTransform& pose, double misfit) {
  if (!guess_ || misfit < guess_->misfit) guess_ = Guess{pose, misfit, seen_motion_};
}

void MarkerTrack::follow(const MarkerObservation& observation, std::int64_t timestamp_ns) {
  const bool is_measured = observation.is_tracked() || observation.state == MarkerState::Ambiguous ||
                           observation.state == MarkerState::Duplicate;
  if (is_measured)
    motion_.follow(observation.camera_from_marker, timestamp_ns, seen_motion_);
  else if (guess_)
    motion_.follow(guess_->camera_from_marker, timestamp_ns, guess_->over_exposure);
  if (observation.is_tracked())
    published_ = MarkerMotion::Sighting{observation.camera_from_marker, timestamp_ns};
  if (is_measured || guess_) is_motion_guessed_ = !is_measured;
  guess_.reset();
  seen_motion_.reset();
  refused_count_ = 0;
  explained_.reset();
  is_undecided_ = false;
}

void MarkerTrack::forget() {
  motion_ = MarkerMotion();
  published_.reset();
  guess_.reset();
  seen_motion_.reset();
  refused_count_ = 0;
  explained_.reset();
  evidence_.start_over();
  is_undecided_ = is_motion_guessed_ = is_sure_ = false;
  is_duplicate = false;
}

}  // namespace arthronaut::markers
