#include "navigation/operation/touches.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::operation {

namespace {

constexpr double kRest_s = 0.25, kLeastRest_s = 0.15, kRestRadius_mm = 1;
constexpr std::size_t kLeastSamples = 3;

}  // namespace

void SteadyTip::add(double time_s, const std::optional<Eigen::Vector3d>& tip_in_marker_mm) {
  if (!samples_.empty() && time_s < samples_.back().time_s) samples_.clear();
  if (tip_in_marker_mm) samples_.push_back({time_s, *tip_in_marker_mm});
  std::erase_if(samples_, [&](const Sample& sample) { return sample.time_s < time_s - kRest_s; });
}

// Many pictures a second are no longer a rest: three of them are 33 ms, in which a moving tip hardly moves.
bool SteadyTip::was_seen_for_long() const {
  return samples_.size() >= kLeastSamples && samples_.back().time_s - samples_.front().time_s >= kLeastRest_s;
}

std::optional<Eigen::Vector3d> SteadyTip::position_mm() const {
  if (!was_seen_for_long()) return std::nullopt;
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Sample& sample : samples_) values.push_back(sample.tip_in_marker_mm[axis]);
    middle[axis] = geometry::median(std::move(values));
  }
  for (const Sample& sample : samples_)
    if ((sample.tip_in_marker_mm - middle).norm() > kRestRadius_mm) return std::nullopt;
  return middle;
}

SteadyTip::Reason SteadyTip::why_not() const {
  if (position_mm()) return Reason::None;
  return was_seen_for_long() ? Reason::Moves : Reason::TipUnknown;
}

std::string in_words(const TouchAlarm& alarm) {
  switch (alarm.kind) {
    case TouchAlarm::Kind::None:
      return "";
    case TouchAlarm::Kind::ControlPointMoved:
      return files::format("The control point has moved by %.1f mm", alarm.control_shift_mm);
    case TouchAlarm::Kind::TouchesOff:
      return files::format("%d touches lie off the bone", alarm.touches_off);
    case TouchAlarm::Kind::Both:
      return files::format("The control point has moved by %.1f mm and a touch lies off the bone",
                           alarm.control_shift_mm);
    case TouchAlarm::Kind::SeenInPicture:
      return files::format("The picture shows the bone %.1f mm from where it lay under its marker",
                           alarm.seen_drift_mm);
  }
  return "";
}

bool denies_drift(double control_shift_mm, double seen_drift_mm) {
  constexpr double kFiner = 0.5;
  return control_shift_mm <= kFiner * seen_drift_mm;
}

WayOut way_out_of(const TouchAlarm& alarm, const Touches& touches) {
  if (!alarm) return WayOut::None;
  using Last = Touches::Last::Kind;
  const Touches::Last last = touches.last();
  const bool has_answered = last.kind == Last::ControlAgain;
  const bool is_seen = alarm.seen_drift_mm > 0;
  const bool may_still_tell =
      is_seen
          ? alarm.control_point_decides &&
                !(has_answered && last.distance_mm && !denies_drift(*last.distance_mm, alarm.seen_drift_mm))
          // Of one touch and one of the control point the latter may still be taken back; one that is set
          // now tells nothing of before.
          : touches.has_control_point() &&
                (alarm.kind == TouchAlarm::Kind::Both || (!has_answered && last.kind != Last::ControlSet));
  if (may_still_tell) return WayOut::ControlPoint;
  return alarm.kind == TouchAlarm::Kind::TouchesOff && !is_seen ? WayOut::StrokesAnew
                                                                : WayOut::MarkerPlacedAnew;
}

void Touches::add_touch(const Eigen::Vector3d& tip_in_marker_mm, const registration::Provenance& of,
                        const Moment& at) {
  // The same place touched again verifies nothing more; one that was touched under another provenance, or
  // that verifies nothing any more, was not touched yet.
  const auto first = touches_.begin() + static_cast<std::ptrdiff_t>(first_to_verify_);
  const bool is_new_place = std::none_of(first, touches_.end(), [&](const Touch& touch) {
    return (touch.tip_in_marker_mm - tip_in_marker_mm).norm() < limits_.apart_mm &&
           !registration::mismatch_of(touch.of, of);
  });
  touches_.push_back({tip_in_marker_mm, of, is_new_place, at});
  last_ = Last::Kind::Touch;
  last_of_ = of;
  last_is_of_now_ = true;
}

void Touches::touch_control_point(const Eigen::Vector3d& tip_in_marker_mm, const registration::Provenance& of,
                                  const Moment& at) {
  last_of_ = of;
  last_is_of_now_ = true;
  control_touches_.push_back({tip_in_marker_mm, of, at});
  last_ = control_touches_.size() == 1 ? Last::Kind::ControlSet : Last::Kind::ControlAgain;
  compare_control_point();
}

// How far it lay off last, and how often in a row: one that is back where it was takes the suspicion away.
void Touches::compare_control_point() {
  control_shift_mm_ = 0;
  control_violations_ = 0;
  for (const ControlTouch& touch : control_touches_) {
    control_shift_mm_ = (touch.tip_in_marker_mm - control_touches_.front().tip_in_marker_mm).norm();
    control_violations_ = control_shift_mm_ > limits_.max_control_shift_mm ? control_violations_ + 1 : 0;
  }
}

Touches::Gone Touches::forget_since(const Moment& moment) {
  const auto is_since = [&](const auto& touch) { return touch.at.is_after(moment); };
  const Gone gone{std::erase_if(touches_, is_since) > 0, std::erase_if(control_touches_, is_since) > 0};
  if (!gone.touches && !gone.control_point) return gone;
  first_to_verify_ = std::min(first_to_verify_, touches_.size());
  compare_control_point();
  last_ = Last::Kind::None;
  return gone;
}

void Touches::clear() { *this = Touches(limits_); }

void Touches::bring_back(const std::vector<Eigen::Vector3d>& touches_mm,
                         const std::optional<Eigen::Vector3d>& control_point_mm,
                         const registration::Provenance& of) {
  clear();
  for (const Eigen::Vector3d& touch_mm : touches_mm) add_touch(touch_mm, of);
  if (control_point_mm) touch_control_point(*control_point_mm, of);
  last_ = Last::Kind::None;
}

std::vector<Eigen::Vector3d> Touches::places_mm() const {
  std::vector<Eigen::Vector3d> places_mm;
  for (const Touch& touch : touches_) places_mm.push_back(touch.tip_in_marker_mm);
  return places_mm;
}

std::optional<Eigen::Vector3d> Touches::control_point_mm() const {
  return control_touches_.empty() ? std::nullopt : std::optional(control_touches_.front().tip_in_marker_mm);
}

std::optional<Eigen::Vector3d> Touches::control_point_mm(const registration::Provenance& now) const {
  const bool is_of_now =
      !control_touches_.empty() && !registration::mismatch_of(control_touches_.back().of, now);
  return is_of_now ? std::optional(control_touches_.back().tip_in_marker_mm) : std::nullopt;
}

void Touches::judge(const registration::RegistrationSummary* registration, const geometry::Surface* surface,
                    const std::optional<registration::CartilageRegion>& cartilage,
                    const registration::Provenance& now) {
  last_is_of_now_ = !registration::mismatch_of(last_of_, now);
  residuals_mm_.clear();
  if (registration == nullptr || !registration->has_pose || surface == nullptr) return;
  const geometry::RigidTransform bone_from_marker = registration->marker_from_bone.inverse();
  for (const Touch& touch : touches_) {
    if (registration::mismatch_of(touch.of, now)) {
      residuals_mm_.emplace_back();
      continue;
    }
    const Eigen::Vector3d p = bone_from_marker * touch.tip_in_marker_mm;
    std::optional<double> residual_mm = surface->signed_distance_mm(p);
    if (cartilage) {
      const auto offset_mm =
          registration::cartilage_offset_mm(*registration, *cartilage, surface->closest_point(p).point_mm);
      residual_mm = offset_mm ? std::optional(*residual_mm - *offset_mm) : std::nullopt;
    }
    residuals_mm_.push_back(residual_mm);
  }
}

Touches::Last Touches::last() const {
  if (!last_is_of_now_) return {};
  Last last{last_, static_cast<int>(touches_.size()), true, std::nullopt, false};
  if (!touches_.empty()) last.is_new_place = touches_.back().is_new_place;
  if (last_ == Last::Kind::ControlAgain) last.distance_mm = control_shift_mm_;
  if (last_ == Last::Kind::Touch && !residuals_mm_.empty()) {
    last.distance_mm = residuals_mm_.back();
    last.is_on_unknown_cartilage = !last.distance_mm;
  }
  return last;
}

int Touches::touches_off() const {
  return static_cast<int>(
      std::count_if(residuals_mm_.begin(), residuals_mm_.end(), [&](const auto& residual_mm) {
        return residual_mm && std::abs(*residual_mm) > limits_.max_touch_error_mm;
      }));
}

TouchAlarm Touches::alarm() const {
  TouchAlarm alarm;
  alarm.control_shift_mm = control_shift_mm_;
  alarm.touches_off = touches_off();
  if (control_violations_ >= limits_.violations_to_alarm)
    alarm.kind = TouchAlarm::Kind::ControlPointMoved;
  else if (alarm.touches_off >= limits_.violations_to_alarm)
    alarm.kind = TouchAlarm::Kind::TouchesOff;
  else if (alarm.touches_off + control_violations_ >= limits_.violations_to_alarm)
    alarm.kind = TouchAlarm::Kind::Both;
  return alarm;
}

std::vector<double> Touches::misses_mm() const {
  std::vector<double> misses_mm;
  for (std::size_t i = first_to_verify_; i < residuals_mm_.size(); ++i)
    if (residuals_mm_[i] && touches_[i].is_new_place) misses_mm.push_back(std::abs(*residuals_mm_[i]));
  return misses_mm;
}

bool Touches::verify() const {
  if (places_to_verify() > 0) return false;
  const std::vector<double> misses_mm = this->misses_mm();
  return *std::max_element(misses_mm.begin(), misses_mm.end()) < limits_.max_verified_mm &&
         geometry::median(misses_mm) < limits_.max_verified_median_mm;
}

int Touches::places_to_verify() const {
  return std::max(limits_.touches_to_verify - static_cast<int>(misses_mm().size()), 0);
}

int Touches::places_since(std::size_t count) const {
  std::vector<Eigen::Vector3d> places_mm;
  for (std::size_t i = count; i < touches_.size(); ++i) {
    const Eigen::Vector3d& tip_mm = touches_[i].tip_in_marker_mm;
    const bool is_new = std::none_of(
        places_mm.begin(), places_mm.end(),
        [&](const Eigen::Vector3d& place_mm) { return (place_mm - tip_mm).norm() < limits_.apart_mm; });
    if (is_new) places_mm.push_back(tip_mm);
  }
  return static_cast<int>(places_mm.size());
}

bool Touches::last_confirms() const {
  return last_ == Last::Kind::Touch && !residuals_mm_.empty() && residuals_mm_.back() &&
         std::abs(*residuals_mm_.back()) < limits_.max_confirming_mm;
}

}  // namespace arthronaut::operation
