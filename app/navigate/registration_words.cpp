#include "app/navigate/registration_words.h"

#include <algorithm>
#include <cmath>

#include "app/navigate/live_words.h"
#include "app/navigate/navigate_display.h"
#include "navigation/operation/operation.h"

namespace arthronaut::navigate {

namespace {

using operation::Standing;
using registration::OnlineState;
using widgets::Severity;

// Strokes shorter than this are crumbs that nobody looks for.
constexpr double kShownLength_mm = 2;
// A next best pose that fits less than so many times worse is worth a look.
constexpr double kClearRatio = 2;
constexpr const char* kNotFound = "Bone not found yet";

// Whose figures may be shown; null: nobody's.
const registration::RegistrationSummary* pose_of(const operation::RegistrationState& state) {
  if (state.in_force.standing == Standing::Stands) return state.in_force.registration.get();
  const bool runs_along = state.online != nullptr && state.online->registration.has_pose;
  return state.in_force.standing == Standing::None && runs_along ? &state.online->registration : nullptr;
}

// What a registration must be of to guide now; nullopt before the first source. The mesh stays the same in an
// operation; the placement of the marker is that of the newest entry under it.
std::optional<registration::Provenance> now_of(const operation::OperationState& state) {
  if (state.source == nullptr) return std::nullopt;
  operation::OperationSetup setup;
  setup.bone = state.bone;
  int placement = 0;
  for (const operation::RegistrationEntry& entry : *state.registration->history)
    if (!entry.marker_has_moved) placement = std::max(placement, entry.of.placement);
  return operation::provenance_of(setup, *state.source, placement);
}

// What is said against an entry now; empty: nothing.
SeverityText against(const operation::RegistrationState& state, std::size_t i,
                     const std::optional<registration::Provenance>& now) {
  const operation::RegistrationEntry& entry = (*state.history)[i];
  if (entry.marker_has_moved) return {Severity::Quiet, "", "the marker was moved or taken out since"};
  if (entry.is_of_wrong_medium) return {Severity::Quiet, "", "it was found through the wrong medium"};
  if (i == state.entry_in_force) {
    const Standing standing = state.in_force.standing;
    const bool is_revoked =
        standing == Standing::Void || standing == Standing::Alarm || standing == Standing::InDoubt;
    if (!is_revoked || state.in_force.registration->reasons.empty()) return {};
    return {standing == Standing::Void ? Severity::Quiet : Severity::Bad, "",
            state.in_force.registration->reasons.front()};
  }
  const auto mismatch = now ? registration::mismatch_of(entry.of, *now) : std::nullopt;
  return {Severity::Quiet, "", mismatch ? registration::in_words(*mismatch, entry.of, *now) : ""};
}

// What is confirmed is verified by touches.
std::string words_of_touches(const operation::Touches& touches) {
  const int missing = touches.places_to_verify();
  if (missing == 0) return "The touches lie too far off the bone to verify: draw more, register anew.";
  // Whoever presses again where it counted already is told why the count stands still.
  const operation::Touches::Last last = touches.last();
  if (last.kind == operation::Touches::Last::Kind::Touch && last.distance_mm && !last.is_new_place)
    return "This place was touched already. Touch " + std::to_string(missing) +
           (missing == 1 ? " other that you know." : " others that you know.");
  return "Touch " + std::to_string(missing) + (missing < touches.limits().touches_to_verify ? " more" : "") +
         (missing == 1 ? " place" : " places") + " that you know, to verify.";
}

// Nobody should read a nought where something was measured.
std::string tenths_of_mm(double value) {
  return (value < 0.05 ? std::string("under 0.1") : widgets::fixed(value, 1)) + " mm";
}

// That the touches lie on the bone is not all that the step of verifying asks: what it lacks stands here,
// too.
RegistrationWords with_what_is_unverified(RegistrationWords words, const operation::OperationState& state) {
  using operation::Unverified;
  if (!is_verified(*state.registration)) return words;
  const Unverified missing = operation::unverified_of(state);
  if (missing == Unverified::ControlPoint) {
    const bool is_set = state.registration->touches.has_control_point();
    words.state = {Severity::Caution, is_set ? "Control point to be touched" : "No control point",
                   is_set ? "Whether the marker sits where it sat, nobody has checked."
                          : "Without one nothing tells whether the marker moves."};
  } else if (missing == Unverified::GuideCheck) {
    words.state = {Severity::Caution, "Guide not checked", "The touches lie on the bone."};
  }
  return words;
}

}  // namespace

SeverityText state_of(const operation::RegistrationState& state) {
  if (!state.bone_trouble.empty()) return {Severity::Bad, "The bone can't be registered", state.bone_trouble};
  const Standing standing = state.in_force.standing;
  const Trouble trouble = trouble_of(state);
  // While the probe draws for one that is reliable, the coach says more.
  const bool is_drawn_anew = standing == Standing::NotReliable && state.online != nullptr &&
                             state.online->state < OnlineState::Confirmed;
  if (!trouble.empty() && !is_drawn_anew) return {Severity::Bad, trouble.headline, trouble.advice + "."};
  if (is_verified(state)) return {Severity::Good, "Verified", "The touches lie on the bone."};
  // What stands need not be what was drawn here: it was given, or brought back.
  if (standing == Standing::Stands) return {Severity::Good, "Confirmed", words_of_touches(state.touches)};
  if (state.online == nullptr)
    return {Severity::Quiet, kNotFound,
            state.drawn->empty() ? "Draw strokes on the bone with the probe."
                                 : "The bone is being made ready; go on drawing."};
  // Whose bone it is, or how large its markers are, no further stroke mends: where to draw it is not said
  // before what speaks against the bone.
  const std::string advice = state.online->bone_is_in_doubt ? "" : state.online->coach.message;
  switch (state.online->state) {
    case OnlineState::Collecting:  // how much more to draw says that it is to be drawn
      return {Severity::Quiet, kNotFound, state.online->coach.missing.empty() ? advice : ""};
    case OnlineState::Candidate:
      return {Severity::Caution, "Bone position not sure yet", advice};
    case OnlineState::Confirmed:
      return {Severity::Caution, "Bone position not in use", advice};
  }
  return {};
}

double progress_of(const operation::RegistrationState& state) {
  if (state.in_force.standing == Standing::Stands) return 1;
  if (state.alarm || state.online == nullptr) return 0;
  return std::clamp(state.online->coach.progress, 0.0, 1.0);
}

std::string missing_of(const operation::RegistrationState& state) {
  if (state.in_force.standing == Standing::Stands) return "";
  if (state.online == nullptr || state.online->state >= OnlineState::Confirmed) return "";
  std::string text;
  for (const std::string& item : state.online->coach.missing) text += (text.empty() ? "" : "; ") + item;
  return text;
}

std::string assumed_of(const operation::RegistrationState& state) {
  const registration::RegistrationSummary* pose = pose_of(state);
  std::string text;
  if (pose == nullptr) return text;
  for (const std::string& item : pose->assumptions) text += (text.empty() ? "Assumed: " : "; ") + item;
  return text;
}

bool waits_for_time_out(const operation::OperationState& state) {
  return state.time_out == operation::TimeOut::Due &&
         state.registration->in_force.standing == Standing::Stands;
}

bool is_verified(const operation::RegistrationState& state) { return state.in_force.is_verified; }

std::vector<SeverityText> numbers_of(const operation::RegistrationState& state) {
  const registration::RegistrationSummary* pose = pose_of(state);
  if (pose == nullptr || state.alarm) return {};  // an alarm belies them
  const double error_mm = pose->predicted_tre_mm;
  const bool is_candidate = state.in_force.standing != Standing::Stands;
  const Severity good = is_candidate ? Severity::Caution : Severity::Good;
  std::vector<SeverityText> rows;
  rows.push_back(
      {error_mm <= registration::kMaxError_mm ? good : Severity::Bad, "At the tunnel",
       widgets::plus_minus(error_mm) + " mm" +
           (is_candidate ? ", " + widgets::plus_minus(state.online->predicted_angle_deg) + "\u00B0" : "")});
  const double ratio = pose->runner_up_ratio;
  if (ratio >= registration::kNoRivalRatio) {
    rows.push_back({good, "No other pose", "comes near"});
  } else if (ratio < registration::kAlikeRatio) {
    // Many measurements tell poses apart that each of them hardly does: what stands is not called bad.
    rows.push_back({is_candidate ? Severity::Bad : Severity::Caution, "Next best pose", "fits almost alike"});
  } else {
    rows.push_back({ratio < kClearRatio ? Severity::Caution : good, "Next best pose",
                    "fits " + widgets::fixed(ratio, 1) + " times worse"});
  }
  return rows;
}

std::optional<TouchText> touch_of(const operation::RegistrationState& state) {
  using Kind = operation::Touches::Last::Kind;
  const operation::Touches::Last last = state.touches.last();
  const operation::TouchLimits limits = state.touches.limits();
  switch (last.kind) {
    case Kind::None:
      return std::nullopt;
    case Kind::ControlSet:
      return TouchText{{Severity::Good, "Control point", "kept"},
                       "Touch it again whenever the marker may have been hit."};
    case Kind::ControlAgain: {
      const bool is_good = *last.distance_mm <= limits.max_control_shift_mm;
      // The probe is finer than the picture, and half as far off as that says is not where it was.
      if (is_good && state.alarm.seen_drift_mm > 0)
        return TouchText{{Severity::Caution, "Control point", tenths_of_mm(*last.distance_mm)},
                         "Too far to deny what the picture shows."};
      return TouchText{
          {is_good ? Severity::Good : Severity::Bad, "Control point", tenths_of_mm(*last.distance_mm)},
          is_good ? "It is where it was." : "It has moved: touch it once more."};
    }
    case Kind::Touch:
      break;
  }
  const std::string name = "Touch " + std::to_string(last.number);
  if (last.is_on_unknown_cartilage)
    return TouchText{{Severity::Quiet, name, "tells nothing"},
                     "Cartilage of unknown thickness: touch bare bone."};
  if (!last.distance_mm)
    return TouchText{{Severity::Quiet, name, "kept"}, "Judged when there is a registration."};
  if (state.in_force.standing == Standing::Void && !state.in_force.can_be_confirmed)
    return TouchText{{Severity::Quiet, name, "tells nothing"}, "The registration is void, whatever it hits."};
  const double off_mm = std::abs(*last.distance_mm);
  const bool is_inside = *last.distance_mm < 0;
  std::string sentence = off_mm < 0.5 ? "On the bone model."
                         : is_inside  ? "Inside the bone model."
                                      : "Above the bone model.";
  if (!last.is_new_place) sentence += " Another place says more.";
  return TouchText{{severity_of_residual(off_mm), name, tenths_of_mm(off_mm)}, sentence};
}

std::vector<StrokeRow> stroke_rows(const operation::RegistrationState& state) {
  std::vector<StrokeRow> rows;
  if (state.online == nullptr) return rows;
  const bool has_pose = state.online->registration.has_pose;
  const bool is_void = state.in_force.standing == Standing::Void;
  for (const registration::StrokeInfo& stroke : state.online->strokes) {
    if (stroke.length_mm < kShownLength_mm) continue;
    StrokeRow row{stroke.curve, state.excluded.contains(stroke.curve), {}};
    row.text.name = "Stroke " + std::to_string(rows.size() + 1);
    row.text.text = widgets::fixed(stroke.length_mm, 0) + " mm";
    if (has_pose) row.text.text += ", " + tenths_of_mm(stroke.median_residual_mm) + " off";
    row.text.severity = has_pose ? severity_of_residual(stroke.median_residual_mm) : Severity::Quiet;
    if (row.is_excluded) row.text.text += ", excluded";
    if (row.is_excluded || is_void) row.text.severity = Severity::Quiet;
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

std::vector<SeverityText> history_rows(const operation::RegistrationState& state,
                                       const std::optional<registration::Provenance>& now) {
  std::vector<SeverityText> rows;
  for (std::size_t i = 0; i < state.history->size(); ++i) {
    const operation::RegistrationEntry& entry = (*state.history)[i];
    const bool counts = entry.registration->has_pose && entry.registration->reliable;
    SeverityText row{counts ? Severity::Good : Severity::Bad,
                     std::to_string(i + 1) + "  " + std::string(to_text(entry.origin)), ""};
    row.text = !counts
                   ? "not reliable"
                   : widgets::plus_minus(entry.registration->predicted_tre_mm) + " mm, fit " +
                         tenths_of_mm(entry.registration->rms_mm) + (entry.is_verified ? ", verified" : "");
    const SeverityText objection = against(state, i, now);
    if (!objection.text.empty()) {
      row.severity = objection.severity;
      row.text = objection.text;
    }
    rows.push_back(row);
  }
  return rows;
}

RegistrationWords words_of(const theatre::LiveState& live) {
  const operation::RegistrationState& state = *live.operation->registration;
  RegistrationWords words{state_of(state),    progress_of(state),
                          missing_of(state),  assumed_of(state),
                          numbers_of(state),  touch_of(state),
                          stroke_rows(state), history_rows(state, now_of(*live.operation))};
  // Beside what is bad nothing is green: a control point that was kept before an alarm says nothing of now.
  if (words.state.severity == Severity::Bad && words.touch && words.touch->number.severity == Severity::Good)
    words.touch->number.severity = Severity::Quiet;
  const bool has_begun = state.point_count > 0 || !state.history->empty();
  const bool nothing_is_drawn =
      live.phase != theatre::LiveState::Phase::Running && state.in_force.standing == Standing::None;
  if (is_of_source_before(live))
    words.state = {Severity::Quiet, "No picture yet",
                   has_begun ? "What was registered is judged with the first pictures." : ""};
  else if (waits_for_time_out(*live.operation))
    words.state = {Severity::Caution, "Waits for the time-out",
                   "What was drawn counts once patient, knee and plan are confirmed."};
  else if (holds_for_time_out(*live.operation) && words.state.severity != Severity::Bad)
    words.state = {Severity::Caution, "Waits for the time-out",
                   "Nothing is drawn or touched before patient, knee and plan are confirmed."};
  else if (live.operation->marker_is_out)
    words.state = {Severity::Quiet, "The marker is out", "What was registered by it has done its work."};
  else if (nothing_is_drawn && state.bone_trouble.empty())  // nothing collects, whatever it had come to
    words.state = {Severity::Quiet, "Not registered",
                   state.point_count > 0 ? "What was drawn is kept. It goes on with the next pictures." : ""};
  else
    return with_what_is_unverified(std::move(words), *live.operation);
  words.progress = 0;
  words.missing.clear();
  words.assumed.clear();
  words.numbers.clear();
  words.touch.reset();
  for (StrokeRow& row : words.strokes) row.text.severity = Severity::Quiet;
  for (SeverityText& row : words.history) row.severity = Severity::Quiet;
  return words;
}

RegistrationWords without_praise(RegistrationWords words) {
  const auto quieten = [](SeverityText& row) {
    if (row.severity == Severity::Good) row.severity = Severity::Quiet;
  };
  quieten(words.state);
  for (SeverityText& row : words.numbers) quieten(row);
  for (StrokeRow& row : words.strokes) quieten(row.text);
  for (SeverityText& row : words.history) quieten(row);
  if (words.touch) quieten(words.touch->number);
  return words;
}

widgets::Severity severity_of_residual(double residual_mm) {
  const double off_mm = std::abs(residual_mm);
  return off_mm < 1                                             ? Severity::Good
         : off_mm < operation::TouchLimits{}.max_touch_error_mm ? Severity::Caution
                                                                : Severity::Bad;
}

}  // namespace arthronaut::navigate
