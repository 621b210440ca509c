#include "app/navigate/registration_words.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::navigate {

namespace {

using registration::OnlineState;
using widgets::Severity;

// Strokes shorter than this are crumbs that nobody looks for.
constexpr double kShownLength_mm = 2;
// As confidence.cpp counts them: below the first two poses are taken for alike; the second is its "no rival".
constexpr double kRivalRatio = 1.15, kNoRivalRatio = 10;

const registration::RegistrationSummary* pose_of(const RegistrationStatus& status) {
  if (status.online != nullptr && status.online->registration.has_pose) return &status.online->registration;
  return status.in_force != nullptr && status.in_force->has_pose ? status.in_force.get() : nullptr;
}

// Nobody should read a nought where something was measured.
std::string tenths_of_mm(double value) {
  return (value < 0.05 ? std::string("under 0.1") : widgets::fixed(value, 1)) + " mm";
}

}  // namespace

SeverityText state_of(const RegistrationStatus& status) {
  if (!status.alarm.empty())
    return {
        Severity::Bad, "World marker may have moved",
        status.alarm + ". Touch the control point again; if it stays off, clear the points and draw anew."};
  if (!status.bone_trouble.empty())
    return {Severity::Bad, "The bone can't be registered", status.bone_trouble};
  if (status.online == nullptr)
    return {Severity::Quiet, "Collecting",
            status.drawn->empty() ? "Draw strokes on the bone with the probe."
                                  : "The bone is being made ready; go on drawing."};
  const std::string& advice = status.online->coach.message;
  switch (status.online->state) {
    case OnlineState::Collecting:
      return {Severity::Quiet, "Collecting", advice};
    case OnlineState::Candidate:
      return {Severity::Caution, "Candidate, not confirmed yet", advice};
    case OnlineState::Confirmed:
      return {Severity::Good, "Confirmed", "Touch three places that you know, to verify."};
    case OnlineState::Verified:
      return {Severity::Good, "Verified", "The touches lie on the bone."};
  }
  return {};
}

double progress_of(const RegistrationStatus& status) {
  if (!status.alarm.empty() || status.online == nullptr) return 0;
  return std::clamp(status.online->coach.progress, 0.0, 1.0);
}

std::string missing_of(const RegistrationStatus& status) {
  if (status.online == nullptr || status.online->state >= OnlineState::Confirmed) return "";
  std::string text;
  for (const std::string& item : status.online->coach.missing)
    text += (text.empty() ? "Missing: " : "; ") + item;
  return text;
}

std::string assumed_of(const RegistrationStatus& status) {
  const registration::RegistrationSummary* pose = pose_of(status);
  std::string text;
  if (pose == nullptr) return text;
  for (const std::string& item : pose->assumptions) text += (text.empty() ? "Assumed: " : "; ") + item;
  return text;
}

bool is_verified(const RegistrationStatus& status) {
  return status.entry_in_force && (*status.history)[*status.entry_in_force].state == OnlineState::Verified;
}

std::vector<SeverityText> numbers_of(const RegistrationStatus& status) {
  const registration::RegistrationSummary* pose = pose_of(status);
  if (pose == nullptr || !status.alarm.empty()) return {};  // an alarm belies them
  const double error_mm = pose->predicted_tre_mm;
  const bool runs_along = status.online != nullptr && pose == &status.online->registration;
  std::vector<SeverityText> rows;
  rows.push_back(
      {error_mm < 1     ? Severity::Good
       : error_mm < 1.5 ? Severity::Caution
                        : Severity::Bad,
       "At the tunnel",
       widgets::plus_minus(error_mm) + " mm" +
           (runs_along ? ", " + widgets::plus_minus(status.online->predicted_angle_deg) + "\u00B0" : "")});
  const double ratio = pose->runner_up_ratio;
  if (ratio >= kNoRivalRatio)
    rows.push_back({Severity::Good, "Next best pose", "none comes near"});
  else
    rows.push_back(
        {ratio < kRivalRatio ? Severity::Bad
         : ratio < 2         ? Severity::Caution
                             : Severity::Good,
         "Next best pose",
         ratio < kRivalRatio ? "fits almost alike" : "fits " + widgets::fixed(ratio, 1) + " times worse"});
  return rows;
}

std::optional<TouchText> touch_of(const RegistrationStatus& status) {
  using Kind = TouchCheck::Last::Kind;
  const TouchCheck::Last last = status.touches.last();
  const registration::OnlineOptions limits;
  switch (last.kind) {
    case Kind::None:
      return std::nullopt;
    case Kind::ControlSet:
      return TouchText{{Severity::Good, "Control point", "kept"},
                       "Touch it again whenever the marker may have been hit."};
    case Kind::ControlAgain: {
      const bool is_good = *last.distance_mm <= limits.max_control_shift_mm;
      return TouchText{
          {is_good ? Severity::Good : Severity::Bad, "Control point", tenths_of_mm(*last.distance_mm)},
          is_good ? "It is where it was." : "It has moved: touch it once more."};
    }
    case Kind::Touch:
      break;
  }
  const std::string name = "Touch " + std::to_string(last.number);
  if (last.is_on_unknown_cover)
    return TouchText{{Severity::Quiet, name, "tells nothing"},
                     "Cartilage of unknown thickness: touch bare bone."};
  if (!last.distance_mm)
    return TouchText{{Severity::Quiet, name, "kept"}, "Judged when there is a registration."};
  const double off_mm = std::abs(*last.distance_mm);
  const bool is_inside = *last.distance_mm < 0;
  std::string sentence = off_mm < 0.5 ? "On the bone model."
                         : is_inside  ? "Inside the bone model."
                                      : "Above the bone model.";
  if (!last.is_new_place) sentence += " Another place says more.";
  return TouchText{{severity_of_residual(off_mm), name, tenths_of_mm(off_mm)}, sentence};
}

std::vector<StrokeRow> stroke_rows(const RegistrationStatus& status) {
  std::vector<StrokeRow> rows;
  if (status.online == nullptr) return rows;
  const bool has_pose = status.online->registration.has_pose;
  for (const registration::StrokeInfo& stroke : status.online->strokes) {
    if (stroke.length_mm < kShownLength_mm) continue;
    StrokeRow row{stroke.curve, status.left_out.contains(stroke.curve), {}};
    row.text.name = "Stroke " + std::to_string(rows.size() + 1);
    row.text.text = widgets::fixed(stroke.length_mm, 0) + " mm";
    if (has_pose) row.text.text += ", " + tenths_of_mm(stroke.median_residual_mm) + " off";
    row.text.severity = has_pose ? severity_of_residual(stroke.median_residual_mm) : Severity::Quiet;
    if (row.is_left_out) {
      row.text.severity = Severity::Quiet;
      row.text.text += ", left out";
    }
    rows.push_back(row);
  }
  return rows;
}

int neighbour_stroke(const std::vector<StrokeRow>& rows, int curve, int step) {
  if (rows.empty()) return -1;
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const StrokeRow& row) { return row.curve == curve; });
  if (found == rows.end()) return rows.back().curve;
  const auto at = std::clamp<std::ptrdiff_t>(found - rows.begin() + step, 0, std::ssize(rows) - 1);
  return rows[static_cast<std::size_t>(at)].curve;
}

std::vector<SeverityText> history_rows(const RegistrationStatus& status) {
  std::vector<SeverityText> rows;
  for (std::size_t i = 0; i < status.history->size(); ++i) {
    const RegistrationEntry& entry = (*status.history)[i];
    const bool counts = entry.registration->has_pose && entry.registration->reliable;
    SeverityText row{counts ? Severity::Good : Severity::Bad, std::to_string(i + 1) + "  " + entry.origin,
                     ""};
    row.text = !counts ? "not reliable"
                       : widgets::plus_minus(entry.registration->predicted_tre_mm) + " mm, fit " +
                             tenths_of_mm(entry.registration->rms_mm) +
                             (entry.state == OnlineState::Verified ? ", verified" : "");
    if (entry.is_void) {
      row.severity = Severity::Quiet;
      row.text = "the marker has moved since";
    }
    rows.push_back(row);
  }
  return rows;
}

RegistrationWords words_of(const RegistrationStatus& status) {
  return {state_of(status),   progress_of(status), missing_of(status),  assumed_of(status),
          numbers_of(status), touch_of(status),    stroke_rows(status), history_rows(status)};
}

widgets::Severity severity_of_residual(double residual_mm) {
  const double off_mm = std::abs(residual_mm);
  return off_mm < 1                                                  ? Severity::Good
         : off_mm < registration::OnlineOptions{}.max_touch_error_mm ? Severity::Caution
                                                                     : Severity::Bad;
}

}  // namespace arthronaut::navigate
