#include "app/navigate/touch_check.h"

#include <algorithm>
#include <cmath>

#include "app/widgets/controls.h"
#include "navigation/registration/online/online_registration.h"

namespace arthronaut::navigate {

namespace {

constexpr double kRest_s = 0.25, kRestRadius_mm = 1;
constexpr std::size_t kLeastSamples = 3;
constexpr int kViolationsToAlarm = 2;

}  // namespace

void SteadyTip::add(double time_s, const std::optional<Eigen::Vector3d>& tip_in_marker_mm) {
  if (!samples_.empty() && time_s < samples_.back().time_s) samples_.clear();
  if (tip_in_marker_mm) samples_.push_back({time_s, *tip_in_marker_mm});
  while (!samples_.empty() && samples_.front().time_s < time_s - kRest_s) samples_.pop_front();
}

std::optional<Eigen::Vector3d> SteadyTip::position_mm() const {
  if (samples_.size() < kLeastSamples) return std::nullopt;
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Sample& sample : samples_) values.push_back(sample.tip_in_marker_mm[axis]);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), at, values.end());
    middle[axis] = *at;
  }
  for (const Sample& sample : samples_)
    if ((sample.tip_in_marker_mm - middle).norm() > kRestRadius_mm) return std::nullopt;
  return middle;
}

std::string SteadyTip::why_not() const {
  if (position_mm()) return "";
  return samples_.size() < kLeastSamples ? "the probe's tip is not known now: show probe and bone marker"
                                         : "the probe moves: hold its tip still";
}

void TouchCheck::add_touch(const Eigen::Vector3d& tip_in_marker_mm) {
  last_is_new_place_ = is_new_place(tip_in_marker_mm);
  touches_mm_.push_back(tip_in_marker_mm);
  last_ = Last::Kind::Touch;
}

bool TouchCheck::is_new_place(const Eigen::Vector3d& tip_in_marker_mm) const {
  constexpr double kApart_mm = 3;
  return std::none_of(touches_mm_.begin(), touches_mm_.end(), [&](const Eigen::Vector3d& touch) {
    return (touch - tip_in_marker_mm).norm() < kApart_mm;
  });
}

void TouchCheck::touch_control_point(const Eigen::Vector3d& tip_in_marker_mm) {
  control_touches_mm_.push_back(tip_in_marker_mm);
  if (control_touches_mm_.size() == 1) {
    last_ = Last::Kind::ControlSet;
    return;
  }
  control_shift_mm_ = (tip_in_marker_mm - control_touches_mm_.front()).norm();
  // One that is back where it was takes the suspicion away.
  control_violations_ =
      control_shift_mm_ > registration::OnlineOptions{}.max_control_shift_mm ? control_violations_ + 1 : 0;
  last_ = Last::Kind::ControlAgain;
}

void TouchCheck::clear() { *this = {}; }

void TouchCheck::judge(const registration::RegistrationSummary* registration,
                       const geometry::Surface* surface,
                       const std::optional<registration::CartilageRegion>& covered) {
  residuals_mm_.clear();
  if (registration == nullptr || !registration->has_pose || surface == nullptr) return;
  const geometry::RigidTransform bone_from_marker = registration->marker_from_bone.inverse();
  for (const Eigen::Vector3d& touch : touches_mm_) {
    const Eigen::Vector3d p = bone_from_marker * touch;
    std::optional<double> residual_mm = surface->signed_distance_mm(p);
    if (covered) {
      const auto offset_mm =
          registration::cover_offset_mm(*registration, *covered, surface->closest_point(p).point_mm);
      residual_mm = offset_mm ? std::optional(*residual_mm - *offset_mm) : std::nullopt;
    }
    residuals_mm_.push_back(residual_mm);
  }
}

TouchCheck::Last TouchCheck::last() const {
  Last last{last_, static_cast<int>(touches_mm_.size()), last_is_new_place_, std::nullopt, false};
  if (last_ == Last::Kind::ControlAgain) last.distance_mm = control_shift_mm_;
  if (last_ == Last::Kind::Touch && !residuals_mm_.empty()) {
    last.distance_mm = residuals_mm_.back();
    last.is_on_unknown_cover = !last.distance_mm;
  }
  return last;
}

std::string TouchCheck::alarm() const {
  if (control_violations_ >= kViolationsToAlarm)
    return "The control point has moved by " + widgets::fixed(control_shift_mm_, 1) + " mm";
  const auto off = std::count_if(residuals_mm_.begin(), residuals_mm_.end(), [](const auto& residual_mm) {
    return residual_mm && std::abs(*residual_mm) > registration::OnlineOptions{}.max_touch_error_mm;
  });
  if (off >= kViolationsToAlarm) return std::to_string(off) + " touches lie off the bone";
  return off + control_violations_ >= kViolationsToAlarm
             ? "The control point has moved by " + widgets::fixed(control_shift_mm_, 1) +
                   " mm and a touch lies off the bone"
             : "";
}

}  // namespace arthronaut::navigate
