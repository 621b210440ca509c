#include "navigation/training/exercise_facts.h"

#include <algorithm>
#include <cmath>

#include "navigation/guidance/guidance.h"
#include "navigation/tools/pivot_calibration.h"

namespace arthronaut::training {

namespace {

using Eigen::Vector3d;

// From here on a registration is wrong for whoever drills by it: a tunnel is taken for well placed within
// this.
constexpr double kWrong_mm = 2.0;

}  // namespace

Examiner::Examiner(const Exercise& exercise, const tunnels::Tunnel& plan, double plan_length_mm,
                   const Vector3d& tip_in_probe_mm)
    : exercise_(exercise), plan_(plan), plan_length_mm_(plan_length_mm), tip_in_probe_mm_(tip_in_probe_mm) {
  plan_.direction.normalize();
}

std::optional<double> Examiner::error_at_entry_mm(const operation::OperationState& state,
                                                  const simulator::HandTruth& truth) const {
  const auto& registration = state.registration->in_force.registration;
  if (registration == nullptr || !registration->has_pose) return std::nullopt;
  const Vector3d& entry = plan_.entry_mm;
  return (registration->marker_from_bone * entry - truth.marker_from_bone * entry).norm();
}

void Examiner::add(const operation::OperationState& state, const simulator::HandTruth& truth) {
  const double dt_s = before_.is_known ? truth.time_s - before_.time_s : 0;
  const double drilled_now_mm = before_.is_known ? truth.hand.drilled_depth_mm - before_.drilled_mm : 0;
  ++facts_.frames;
  facts_.time_s = truth.time_s;
  facts_.marker_was_bumped = facts_.marker_was_bumped || truth.has(simulator::FaultKind::BumpedMarker);
  const bool is_probe = truth.hand.held == simulator::Held::Probe;
  const auto& tools = state.source->pipeline.tools.tools;
  const auto& options = state.source->pipeline;
  bool tool_is_seen = false;
  for (std::size_t i = 0; i < tools.size() && i < state.frame.tools.size(); ++i) {
    if (tools[i].name != (is_probe ? options.probe_name : options.guide_name)) continue;
    tool_is_seen = state.frame.tools[i].world_from_tool.is_valid;
    if (is_probe && tool_is_seen && exercise_.goal == Goal::Pivot)
      world_from_probe_.push_back(state.frame.tools[i].world_from_tool.target_from_source);
  }
  if (!tool_is_seen) facts_.unseen_s += dt_s;
  follow_touches(state);
  follow_drawing(state, truth);
  follow_alarm(state, drilled_now_mm);
  follow_guide(state, truth);
  before_.is_known = true;
  before_.time_s = truth.time_s;
  before_.drilled_mm = truth.hand.drilled_depth_mm;
  before_.tip_mm = truth.hand.probe_tip_mm;
}

void Examiner::follow_touches(const operation::OperationState& state) {
  const operation::Touches& touches = state.registration->touches;
  const bool was_refused =
      state.touch_refusal != operation::TouchRefusal::None && state.touch_asked_ns != before_.touch_asked_ns;
  before_.touch_asked_ns = state.touch_asked_ns;
  if (was_refused) {
    ++facts_.touches;
    ++facts_.wasted_touches;
  }
  if (touches.count() > before_.touch_count) {
    const bool tells_nothing =
        state.registration->in_force.registration == nullptr || !touches.last().is_new_place;
    ++facts_.touches;
    facts_.wasted_touches += tells_nothing ? 1 : 0;
  }
  before_.touch_count = touches.count();
  facts_.verification_was_skipped = state.verification == operation::Verification::Skipped;
  // Enough that lie off the bone verify nothing: one more is missing.
  facts_.verifying_touches_missing = state.verification == operation::Verification::ByTouches ? 0
                                     : facts_.verification_was_skipped
                                         ? touches.limits().touches_to_verify
                                         : std::max(1, touches.places_to_verify());
}

// The operation has taken a point: it is drawn, wherever the tip truly was.
void Examiner::follow_drawing(const operation::OperationState& state, const simulator::HandTruth& truth) {
  const std::size_t points = state.registration->point_count;
  if (before_.is_known && points > before_.point_count) {
    const double step_mm = (truth.hand.probe_tip_mm - before_.tip_mm).norm();
    facts_.drawn_mm += step_mm;
    if (!truth.hand.touches_bone) facts_.drawn_in_air_mm += step_mm;
  }
  before_.point_count = points;
}

void Examiner::follow_alarm(const operation::OperationState& state, double drilled_now_mm) {
  const bool is_on = static_cast<bool>(state.registration->alarm);
  if (is_on && !before_.alarm) {
    ++facts_.alarms;
    before_.drilled_in_alarm = false;
  }
  if (is_on && drilled_now_mm > 0 && !before_.drilled_in_alarm) {
    before_.drilled_in_alarm = true;
    ++facts_.alarms_ignored;
  }
  // Over without another registration, though the marker had truly moved: it was waved away.
  const bool is_over = before_.alarm && !is_on;
  // Not by change_count: the alarm's end changes what is in force, from doubted to not.
  const operation::RegistrationState& known = *state.registration;
  const bool same_registration = known.in_force.registration != nullptr &&
                                 known.entry_in_force == before_.entry_in_force &&
                                 known.history->size() == before_.registrations;
  if (is_over && same_registration && facts_.marker_was_bumped && !before_.drilled_in_alarm)
    ++facts_.alarms_ignored;
  before_.alarm = is_on;
  before_.entry_in_force = known.entry_in_force;
  before_.registrations = known.history->size();
}

void Examiner::follow_guide(const operation::OperationState& state, const simulator::HandTruth& truth) {
  const std::optional<double> error_mm = error_at_entry_mm(state, truth);
  // What the program refuses to guide by is no registration, exact or not.
  const bool stands = state.registration->in_force.standing == operation::Standing::Stands;
  facts_.tunnel_error_mm = stands ? error_mm : std::nullopt;
  const bool is_wrong = error_mm && *error_mm > kWrong_mm;
  const bool guides_rightly = state.frame.guidance.is_valid() && !is_wrong;
  if (guides_rightly) before_.guided_s = before_.time_s;
  if (truth.hand.held != simulator::Held::Guide) {
    before_.guides_rightly = guides_rightly;
    return;
  }
  const simulator::HandState& hand = truth.hand;
  const double drilled_now_mm = before_.is_known ? hand.drilled_depth_mm - before_.drilled_mm : 0;
  if (drilled_now_mm > 0 && !guides_rightly) {
    facts_.bad_data_mm += drilled_now_mm;
    if (is_wrong) facts_.worst_bad_error_mm = std::max(facts_.worst_bad_error_mm, *error_mm);
  }
  before_.guides_rightly = guides_rightly;
  before_.error_mm = error_mm.value_or(0);
  // The guide stands still while it drills: the tunnel is where it began.
  if (exercise_.goal == Goal::Drill && hand.drilled_depth_mm <= 0) return;
  // As guidance has it, so that the score and the screen say the same.
  facts_.entry_offset_mm =
      (guidance::crossing_of(hand.guide_point_mm, hand.guide_direction, plan_) - plan_.entry_mm).norm();
  facts_.angle_deg =
      geometry::deg_from_rad(geometry::angle_between_rad(hand.guide_direction, plan_.direction));
  if (exercise_.goal == Goal::Aim) facts_.off_bone_mm = hand.off_bone_mm;
  if (exercise_.goal == Goal::Drill) facts_.depth_error_mm = hand.drilled_depth_mm - plan_length_mm_;
}

void Examiner::finish() {
  facts_.is_done = true;
  // Who says that the guide stands right while nothing guides has guessed; a picture or two without numbers
  // in the moment of the key are nobody's fault.
  constexpr double kMoment_s = 0.5;
  if (exercise_.goal == Goal::Aim && !before_.guides_rightly &&
      before_.time_s - before_.guided_s > kMoment_s) {
    facts_.bad_data_mm = facts_.entry_offset_mm.value_or(0) + 2;
    facts_.worst_bad_error_mm = before_.error_mm;
  }
}

ExerciseFacts Examiner::facts() const {
  ExerciseFacts facts = facts_;
  if (exercise_.goal != Goal::Pivot) return facts;
  const tools::PivotCalibrationSummary pivot = tools::calibrate_pivot(world_from_probe_);
  if (pivot.is_usable())
    facts.tip_error_mm = (pivot.tip_in_tool_mm - tip_in_probe_mm_).norm();
  else
    facts.tip_trouble = pivot.reasons.empty() ? "no tip was found" : pivot.reasons.front();
  return facts;
}

}  // namespace arthronaut::training
