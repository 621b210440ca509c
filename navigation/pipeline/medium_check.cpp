#include "navigation/pipeline/medium_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/camera/medium.h"
#include "navigation/markers/planar_pose.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::pipeline {

namespace {

using markers::MarkerState;

std::int64_t ns_from_s(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

// An index so near looks alike: it moves a pose by less than is said of its error.
constexpr double kAlike = 0.03;

// What may be before the lens in place of the stated medium, the likelier first: air and fluid are what there
// is, and a number between or beyond them may be a mistake for either.
std::span<const double> others_than(double stated) {
  static constexpr std::array kFluidThenAir{camera::kSalineIndex, camera::kAirIndex};
  const std::span<const double> all(kFluidThenAir);
  if (std::abs(stated - camera::kSalineIndex) <= kAlike) return all.last(1);
  if (std::abs(stated - camera::kAirIndex) <= kAlike) return all.first(1);
  return all;
}

// How far corners lie from those of a square, at best; infinite when no pose gives anything like them.
double misfit_px(const camera::CameraModel& camera, const markers::Corners& corners_px, double size_mm) {
  const auto poses = markers::solve_square(camera, corners_px, size_mm);
  return poses ? poses->best.rms_px : HUGE_VAL;
}

// The marker is there, and its pose does not stand, or stands badly: what the wrong medium makes of most.
bool is_strained(const markers::MarkerObservation& marker, double clean_px) {
  if (marker.is_tracked()) return marker.rms_px > clean_px;
  return marker.state == MarkerState::Covered || marker.state == MarkerState::Doubtful ||
         marker.state == MarkerState::Ambiguous;
}

}  // namespace

std::string reason_text(const MediumVerdict& verdict) {
  if (verdict.fit != MediumFit::Contradicts) return "";
  const std::string stated = camera::medium_to_text(verdict.stated_index);
  return "the markers look as in " + camera::medium_to_text(verdict.other_index) + ", not as in " + stated +
         files::format(" (corners fit to %.2f px, not %.2f)", verdict.other_rms_px, verdict.stated_rms_px) +
         ": is the medium right?";
}

MediumCheck::MediumCheck(std::span<const markers::DeclaredMarker> declared, double refractive_index,
                         double calibration_index, const MediumCheckOptions& options)
    : options_(options),
      calibration_index_(calibration_index),
      declared_(declared.begin(), declared.end()),
      next_vote_ns_(declared.size(), 0) {
  for (const double index : {refractive_index, calibration_index})
    if (!(index >= 0.9 && index <= 2)) throw InvalidInput("a refractive index must lie in [0.9, 2]");
  verdict_.stated_index = refractive_index;
  verdict_.other_index = others_than(refractive_index).front();
  hold();
}

void MediumCheck::hold() {
  verdict_.is_held = true;
  quiet_looks_ = 0;
  well_since_ns_ = -1;
}

// In the wrong medium hardly any marker stands well for long; one that does looks alike in every medium.
void MediumCheck::follow_hold(bool stand_well) {
  if (!stand_well)
    well_since_ns_ = -1;
  else if (well_since_ns_ < 0)
    well_since_ns_ = now_ns_;
  const double needed_s = is_in_doubt_ ? options_.well_s : options_.unconfirmed_s;
  if (stand_well && now_ns_ - well_since_ns_ >= ns_from_s(needed_s)) verdict_.is_held = false;
}

void MediumCheck::look(const PictureObservation& view) {
  wants_second_look_ = false;
  if (!view.intrinsics_are_known || view.is_frozen) return;
  if (!has_begun_) confirmed_ns_ = view.timestamp_ns;
  has_begun_ = true;
  now_ns_ = view.timestamp_ns;
  bool is_any_strained = false, is_any_tracked = false;
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    const markers::MarkerObservation& marker = view.markers[i];
    is_any_strained |= is_strained(marker, options_.clean_px);
    is_any_tracked |= marker.is_tracked();
    if (!marker.is_tracked() || now_ns_ < next_vote_ns_[i]) continue;
    next_vote_ns_[i] = now_ns_ + ns_from_s(options_.vote_every_s);
    vote(view.camera, marker, declared_[i].size_mm, true);
  }
  decide();
  follow_hold(is_any_tracked && !is_any_strained);
  const double pause_s = score_ < 0 || is_in_doubt_ ? options_.follow_up_s : options_.look_every_s;
  const bool is_unconfirmed = now_ns_ - confirmed_ns_ >= ns_from_s(options_.unconfirmed_s);
  const bool is_rested = !has_looked_ || now_ns_ - looked_ns_ >= ns_from_s(pause_s);
  wants_second_look_ = is_any_strained && is_unconfirmed && is_rested;
}

void MediumCheck::look_again(const PictureObservation& view,
                             std::span<const markers::MarkerObservation> in_other_medium) {
  wants_second_look_ = false;
  has_looked_ = true;
  looked_ns_ = view.timestamp_ns;
  const long against_before = verdict_.votes_against;
  for (std::size_t i = 0; i < declared_.size() && i < in_other_medium.size(); ++i) {
    // What stands well in the stated medium has its own vote; in the other one it leans towards that.
    const markers::MarkerObservation& stated = view.markers[i];
    if (stated.is_tracked() && stated.rms_px <= options_.clean_px) continue;
    if (!in_other_medium[i].is_tracked() || in_other_medium[i].rms_px > options_.clean_px) continue;
    vote(view.camera, in_other_medium[i], declared_[i].size_mm, false);
  }
  if (verdict_.votes_against == against_before && ++quiet_looks_ >= (is_in_doubt_ ? options_.quiet_looks : 1))
    verdict_.is_held = false;
  decide();
}

void MediumCheck::vote(const camera::CameraModel& stated, const markers::MarkerObservation& seen,
                       double size_mm, bool may_be_for) {
  const double stated_px = misfit_px(stated, seen.corners_px, size_mm);
  double other_px = HUGE_VAL, other_index = verdict_.other_index;
  for (const double index : others_than(verdict_.stated_index)) {
    const double px = misfit_px(stated.in_medium(index / calibration_index_), seen.corners_px, size_mm);
    if (px >= other_px) continue;
    other_px = px;
    other_index = index;
  }
  const auto speaks_for = [&](double right_px, double wrong_px) {
    return right_px <= options_.clean_px && wrong_px > options_.wrong_px &&
           wrong_px > options_.least_ratio * right_px;
  };
  if (may_be_for && speaks_for(stated_px, other_px)) {
    ++verdict_.votes_for;
    score_ += options_.weight_for;
    confirmed_ns_ = voted_for_ns_ = now_ns_;
    if (score_ >= score_before_doubt_) is_in_doubt_ = false;
    if (!is_in_doubt_) verdict_.is_held = false;
  } else if (speaks_for(other_px, stated_px)) {
    ++verdict_.votes_against;
    verdict_.other_index = other_index;
    if (!is_in_doubt_) {
      is_in_doubt_ = true;
      score_before_doubt_ = score_;
      verdict_.last_sure_ns = has_fitted_ ? voted_for_ns_ : -1;
    }
    score_ -= options_.weight_against;
    hold();
    // What fits no square at all says no more than one that is 10 px off.
    stated_square_ += std::pow(std::min(stated_px, 10.0), 2);
    other_square_ += other_px * other_px;
  }
  score_ = std::clamp(score_, -options_.limit, options_.limit);
}

void MediumCheck::decide() {
  if (verdict_.votes_against > 0) {
    const auto count = static_cast<double>(verdict_.votes_against);
    verdict_.stated_rms_px = std::sqrt(stated_square_ / count);
    verdict_.other_rms_px = std::sqrt(other_square_ / count);
  }
  const bool contradicted = verdict_.fit == MediumFit::Contradicts;
  // Between the bounds a verdict stays: on the way from one to the other nothing is known.
  if (score_ <= options_.contradicts_at)
    verdict_.fit = MediumFit::Contradicts;
  else if (score_ >= options_.fits_at)
    verdict_.fit = MediumFit::Fits;
  else if (verdict_.fit == MediumFit::Fits ? score_ < 0 : score_ > 0)
    verdict_.fit = MediumFit::Unknown;
  has_fitted_ = has_fitted_ || verdict_.fit == MediumFit::Fits;
  if (contradicted && verdict_.fit != MediumFit::Contradicts) is_in_doubt_ = false;
}

void MediumCheck::reset() {
  std::fill(next_vote_ns_.begin(), next_vote_ns_.end(), 0);
  now_ns_ = confirmed_ns_ = looked_ns_ = 0;
  has_begun_ = has_looked_ = wants_second_look_ = false;
  score_ = score_before_doubt_ = 0;
  is_in_doubt_ = has_fitted_ = false;
  voted_for_ns_ = -1;
  stated_square_ = other_square_ = 0;
  MediumVerdict fresh;
  fresh.stated_index = verdict_.stated_index;
  fresh.other_index = verdict_.other_index;
  verdict_ = fresh;
  hold();
}

SecondLook::SecondLook(std::span<const markers::DeclaredMarker> declared, double other_index,
                       double calibration_index)
    : index_ratio_(other_index / calibration_index), tracker_(markers::make_tracker(declared)) {}

std::span<const markers::MarkerObservation> SecondLook::look(const camera::Frame& frame,
                                                             const camera::CameraModel& camera) {
  tracker_->reset();
  return tracker_->track(camera::luma_of(frame, gray_), camera.in_medium(index_ratio_), frame.timestamp_ns);
}

}  // namespace arthronaut::pipeline
