#include <algorithm>

#include "navigation/operation/operation_parts.h"
#include "planning/files/format.h"

namespace arthronaut::operation {

void Operation::Parts::note_in_force(bool is_given) {
  JournalEntry entry;
  entry.kind = JournalKind::RegistrationInForce;
  entry.registration = ledger.in_force().registration;
  entry.of = ledger.now();
  if (entry.registration == nullptr) {  // what was kept before must not be found again
    auto none = std::make_shared<registration::RegistrationSummary>();
    none->reasons = {why_none};
    entry.registration = std::move(none);
  }
  if (ledger.entry_in_force()) entry.of = (*ledger.entries())[*ledger.entry_in_force()].of;
  entry.registration_was_given = is_given;
  note(std::move(entry));
}

// With what its strokes have in common with all that is measured by it. What came from elsewhere has none
// that is known here.
void Operation::Parts::hand_registration() {
  const RegistrationPtr& in_force = ledger.in_force().registration;
  if (in_force == nullptr) return pipeline->set_registration(std::nullopt);
  const RegistrationOrigin origin = (*ledger.entries())[*ledger.entry_in_force()].origin;
  const bool is_of_strokes =
      origin == RegistrationOrigin::WhileDrawing || origin == RegistrationOrigin::AllStrokes;
  pipeline->set_registration(
      *in_force, is_of_strokes ? stroke_bias.of_registration(*ledger.entry_in_force()) : std::nullopt);
}

// What is in force guides from the next frame on; what is not any more does not guide in it.
void Operation::Parts::follow_ledger() {
  const RegistrationInForce& in_force = ledger.in_force();
  const bool is_another = ledger.change_count() != followed.change;
  bone_watch.on_registration(in_force);
  stroke_bias.on_registrations(ledger.entries()->size(), strokes);
  if (is_another) {
    followed.change = ledger.change_count();
    if (pipeline != nullptr) hand_registration();
    // The picture's numbers, and what was seen of the guide, were by what is not in force any more.
    hide_guidance(guidance::GuidanceState::Stale);
    drilling.on_registration();
    in_view.on_registration();
    grades.on_other_numbers();
    if (in_force.registration != nullptr) {
      const RegistrationOrigin origin = (*ledger.entries())[*ledger.entry_in_force()].origin;
      note_in_force(origin == RegistrationOrigin::Given || origin == RegistrationOrigin::Resumed);
    } else {
      note_in_force(false);
    }
  }
  // Of another one that is void too, the journal says so too.
  if (in_force.standing != followed.standing || (is_another && in_force.standing == Standing::Void)) {
    const std::string why = in_force.registration != nullptr && !in_force.registration->reasons.empty()
                                ? in_force.registration->reasons.front()
                                : "";
    if (followed.standing == Standing::Alarm) note(JournalKind::Alarm);
    if (in_force.standing == Standing::Alarm) note(JournalKind::Alarm, why);
    if (in_force.standing == Standing::Void) note(JournalKind::Void, why);
    if (followed.standing == Standing::Void && in_force.standing == Standing::Stands &&
        ledger.entry_in_force() == followed.entry) {
      note(JournalKind::Confirmed, "by a touch");
      skipped_entry.reset();  // that was under other circumstances
    }
    followed.standing = in_force.standing;
  }
  followed.entry = ledger.entry_in_force();
  if (followed.verified_entry && followed.verified_entry == followed.entry &&
      !(*ledger.entries())[*followed.entry].is_verified) {
    followed.verified_entry.reset();
    note(JournalKind::VerificationLost, ledger.touches().lie_off_the_bone()
                                            ? "a touch lies off the bone"
                                            : "its touches do not count any more");
  }
  if (in_force.is_verified) followed.verified_entry = followed.entry;
  if (in_force.is_verified && (!followed.is_verified || is_another)) note(JournalKind::Verified);
  followed.is_verified = in_force.is_verified;
  changed = true;
}

void Operation::Parts::set_plan(const std::optional<PlannedTunnel>& next, bool moves_target) {
  plan = next;
  if (moves_target) {
    ledger.aim_at(plan ? std::optional(plan->tunnel.entry_mm) : std::nullopt);
    ask(plan ? AimAt{plan->tunnel.entry_mm, plan->tunnel.direction} : AimAt{std::nullopt, std::nullopt});
    fit.on_aim();
  }
  // What was seen, read and drilled was of another plan; the numbers of the last picture are too.
  drilling.on_plan(plan);
  grades.on_other_numbers();
  hide_guidance(guidance::GuidanceState::Stale);
  if (pipeline != nullptr)
    pipeline->set_plan(plan ? std::optional(plan->tunnel) : std::nullopt, plan ? plan->length_mm : 0);
  note_plan();
}

std::optional<std::size_t> Operation::Parts::guide_in_view() const {
  const pipeline::PipelineOptions& options = source->pipeline;
  const tools::Tool* guide = options.tools.find_tool(options.guide_name);
  for (std::size_t i = 0; guide != nullptr && i < frame.tools.size(); ++i)
    if (frame.tools[i].marker_id == guide->marker_id && frame.tools[i].world_from_tool.is_valid) return i;
  return std::nullopt;
}

void Operation::Parts::take_frame() {
  ++frame_count;
  ledger.set_time(frame.timestamp_ns);
  // A drill with a marker of its own is seen, and said, without the guide.
  const auto guides = [this] { return frame.guidance.is_valid() || frame.guidance.drill; };
  if (guides() && time_out() == TimeOut::Due) hide_guidance(guidance::GuidanceState::NotConfirmed);
  if (guides() && timing != PictureTiming::InTime) hide_guidance(hidden_as(timing));
  if (frame.guidance.is_valid() && !guide_check.state().may_guide()) hide_guide();
  const double time_s = static_cast<double>(frame.timestamp_ns) * 1e-9;
  guide_check.add(frame);
  tip.add(time_s, frame.tip_is_valid ? std::optional(frame.tip_in_world_mm) : std::nullopt);
  draw_tip();
  watch_guidance();
  look_for_registration();
}

void Operation::Parts::draw_tip() {
  if (!draws || !frame.tip_is_valid || holds_for_time_out()) return;
  if (strokes.points().empty()) strokes_of = ledger.now();
  const double time_s = static_cast<double>(frame.timestamp_ns) * 1e-9;
  const strokes::CurvePoint* const before = strokes.points().empty() ? nullptr : &strokes.points().back();
  const int curve_before = before != nullptr ? before->curve : -1;
  const Eigen::Vector3d at_before = before != nullptr ? before->position_mm : frame.tip_in_world_mm;
  const strokes::CurvePoint point = strokes.add(time_s, frame.tip_in_world_mm, frame.shaft_in_world);
  const double step_mm = point.curve == curve_before ? (point.position_mm - at_before).norm() : 0;
  stroke_bias.add(point.curve, frame.tip_sensitivity, step_mm);
  ask(DrawnPoint{point});
}

void Operation::Parts::hide_guidance(guidance::GuidanceState reason) {
  const std::int64_t timestamp_ns = frame.guidance.timestamp_ns;
  frame.guidance = {};
  frame.guidance.timestamp_ns = timestamp_ns;
  frame.guidance.state = reason;
}

// The guide's numbers alone: no guide makes what is seen of a drill by its own marker wrong.
void Operation::Parts::hide_guide() {
  const std::optional<guidance::DrillDepth> drill = frame.guidance.drill;
  hide_guidance(guidance::GuidanceState::GuideNotChecked);
  frame.guidance.drill = drill;
}

void Operation::Parts::watch_guidance() {
  const InView::News news =
      in_view.add(frame.timestamp_ns, frame.world_is_seen(), guide_in_view().has_value());
  if (news.guide_is_new) changed = true;
  if (news.marker_is_back) {
    marker_may_have_moved();
    follow_ledger();
  }
  if (marker_is_out && is_live() && frame.world_is_seen()) {
    marker_is_out = false;
    note(JournalKind::MarkerOut, "the world marker is seen again: it is not out");
  }
  grades.add(frame.guidance, frame.timestamp_ns);
  drilling.add(frame.guidance, frame.timestamp_ns);
  if (frame.guidance.is_valid() || frame.guidance.is_too_late()) in_view.guided(frame.timestamp_ns);
  // The hand follows a drill's numbers as it follows a guide's.
  const bool drill_is_followed = frame.guidance.drill && frame.guidance.drill->is_at_plan();
  if ((frame.guidance.is_valid() || drill_is_followed) && verification() == Verification::NotYet)
    skip_verification("guidance began without one");
}

bool Operation::Parts::rests_on_marker() const {
  const RegistrationInForce& in_force = ledger.in_force();
  const bool is_void_for_good = in_force.standing == Standing::Void && !in_force.can_be_confirmed;
  return (in_force.standing != Standing::None && !is_void_for_good) || !strokes.points().empty() ||
         ledger.touches().count() > 0 || ledger.touches().has_control_point();
}

// Nobody saw it meanwhile, and a hand may have hit it.
void Operation::Parts::marker_may_have_moved() {
  if (!rests_on_marker()) return;
  changed = true;
  loss.begin(ledger.touches().has_control_point(), ledger.touches().count());
  if (!loss.control_point_ends()) ledger.verify_anew();
}

// By nothing that rests on the marker any more, or by as many places as verify.
void Operation::Parts::look_for_end_of_loss() {
  loss.on_touches(ledger.touches());
  if (!rests_on_marker() || (!loss.control_point_ends() && loss.places_to_touch(ledger.touches()) == 0))
    loss.end();
}

void Operation::Parts::skip_verification(const std::string& how) {
  if (verification() != Verification::NotYet || !ledger.entry_in_force()) return;
  skipped_entry = ledger.entry_in_force();
  const int wanted = setup.limits.touches_to_verify, missing = ledger.touches().places_to_verify();
  std::string touched;
  if (missing < wanted)
    touched = files::format("; %d of %d touches had been taken", wanted - missing, wanted);
  note(JournalKind::VerificationSkipped, how + touched + (missing == 0 ? ", too far off to verify" : ""));
}

Verification Operation::Parts::verification() const {
  if (ledger.in_force().is_verified) return Verification::ByTouches;
  return ledger.entry_in_force() && skipped_entry == ledger.entry_in_force() ? Verification::Skipped
                                                                             : Verification::NotYet;
}

void Operation::Parts::look_for_registration() {
  if (!setup.registers_after_mm || !plan || !guide_in_view() || !fit.is_time_to_look(frame.timestamp_ns))
    return;
  const std::optional<std::size_t> entry = ledger.entry_in_force();
  const bool is_settled = entry && (*ledger.entries())[*entry].origin != RegistrationOrigin::WhileDrawing &&
                          ledger.in_force().standing == Standing::Stands;
  if (is_settled || strokes::length_mm(strokes.in_use()) < fit.length_mm() + *setup.registers_after_mm)
    return;
  register_strokes();
}

void Operation::Parts::register_strokes() {
  if (fit.is_under_way() || (outcome != nullptr && !outcome->failure.empty())) return;
  changed = true;
  auto of_all = fit.ask(strokes);
  if (!of_all) return;
  ask(std::move(*of_all));
  fit.asked_with(request_count);
}

void Operation::Parts::clear_strokes() {
  strokes.clear();
  stroke_bias.on_strokes_cleared();
  fit.on_strokes_cleared();
  ask(StrokesCleared{});
  online.reset();
  ledger.forget_strokes();
}

void Operation::Parts::find_anew(std::string why) {
  why_none = std::move(why);
  clear_strokes();
  drilling.on_marker_placed_anew();
  ledger.marker_placed_anew();
  marker_is_out = false;
}

void Operation::Parts::take_touch(bool is_control_point) {
  if (holds_for_time_out()) {
    touch = {TouchRefusal::TimeOutDue, false, frame.timestamp_ns};
    return;
  }
  draws = false;
  touch = {TouchRefusal::None, false, frame.timestamp_ns};
  const auto tip_mm = tip.position_mm();
  if (!has_source || !tip_mm) {
    touch.refusal = !has_source ? TouchRefusal::NoSource : refusal_of(tip.why_not());
    return;
  }
  if (!is_control_point) return ledger.add_touch(*tip_mm);
  const bool is_set = ledger.touches().has_control_point();
  if (const TouchAlarm alarm = ledger.alarm(); alarm.seen_drift_mm > 0 && !alarm.control_point_decides)
    return note(JournalKind::Note,
                is_set ? "control point not asked: it was set when the bone may have moved already"
                       : "control point not set: the picture shows that the bone has moved");
  if (!is_set) in_view.control_point_set(frame.timestamp_ns);
  ledger.touch_control_point(*tip_mm);
  // What asked for it asks on: whether the marker has moved is not answered.
  if (ledger.touches().control_point_lies_off()) return;
  in_view.control_point_held(frame.timestamp_ns);
  if (loss.control_point_ends()) loss.end();
  if (bone_watch.doubt().control_point_ends()) bone_watch.look_anew();
}

// In a recording and in a simulation no hand takes out what their pictures show.
void Operation::Parts::apply(const MarkerOut& out) {
  touch = {TouchRefusal::None, false, frame.timestamp_ns};
  const std::int64_t now_ns = frame.timestamp_ns + static_cast<std::int64_t>(1e9 * out.without_picture_s);
  if (is_live() && in_view.marker_is_seen(now_ns)) {
    touch.refusal = TouchRefusal::MarkerIsSeen;
    return;
  }
  find_anew("the world marker is out of the bone");
  marker_is_out = true;
  note(JournalKind::MarkerOut);
}

void Operation::Parts::apply(const OfferPlan& offer) {
  offered.reset();
  resumed_plan_waits = false;
  if (offer.plan == plan) return;
  // An operation that was gone on with is under way before its next source begins, too.
  resumed_plan_waits = !has_source && resumed != nullptr;
  if (has_source || resumed_plan_waits)
    offered = offer;
  else
    set_plan(offer.plan, offer.moves_target);
}

void Operation::Parts::apply(const GiveRegistration& give) {
  registration::Provenance of = give.of;
  // Nobody saw the marker meanwhile: one touch has to show that it sits where it sat.
  if (give.is_resumed) of.placement = ledger.now().placement - 1;
  ledger.give(give.is_resumed ? RegistrationOrigin::Resumed : RegistrationOrigin::Given,
              std::make_shared<const registration::RegistrationSummary>(give.registration), of);
}

int Operation::Parts::places_in_doubt() const {
  const Touches& touches = ledger.touches();
  return std::max(bone_watch.doubt().places_to_touch(touches), loss.places_to_touch(touches));
}

// It is told a second or more after the bone has moved. A control point that was set meanwhile says that the
// bone lies where it lies now, and nothing of whether it moved.
void Operation::Parts::take_seen() {
  take_medium();
  if (const auto looks = bone_watch.take_looks(); looks && ledger.in_force().standing == Standing::Stands) {
    note(JournalKind::BoneLooks, to_text(*looks));
    const bool was_set_before =
        ledger.touches().has_control_point() && in_view.control_point_was_set_before(looks->held_until_ns);
    if (looks->otherwise)
      bone_watch.begin_doubt(was_set_before, ledger.touches().count());
    else
      bone_watch.end_doubt();
  }
  const auto drift = bone_watch.take_drift();
  if (!drift || ledger.in_force().standing != Standing::Stands) return;
  note(JournalKind::BoneMoved, to_text(*drift));
  ledger.bone_moved_in_picture(drift->drift_mm, in_view.control_point_was_set_before(drift->held_until_ns));
  follow_ledger();
}

ControlPointDue Operation::Parts::control_point_due() const {
  if (!has_source || ledger.in_force().standing != Standing::Stands) return ControlPointDue::None;
  if (ledger.touches().control_point_lies_off()) return ControlPointDue::CheckShift;
  if (bone_watch.doubt().control_point_ends()) return ControlPointDue::CheckLooks;
  if (bone_watch.doubt().places_to_touch(ledger.touches()) > 0) return ControlPointDue::CannotCheckLooks;
  if (loss.control_point_ends()) return ControlPointDue::CheckAfterLoss;
  if (loss.places_to_touch(ledger.touches()) > 0) return ControlPointDue::CannotCheckLoss;
  if (!ledger.touches().has_control_point()) return ControlPointDue::Set;
  return in_view.control_point_is_old(frame.timestamp_ns) ? ControlPointDue::CheckBeforeDrilling
                                                          : ControlPointDue::None;
}

RegistrationStatePtr Operation::Parts::registration_state() {
  // Not by how often somebody asked: a point that the trace does not show counts too.
  if (!changed && published_registration != nullptr && published_registration->drawn == strokes.trace() &&
      published_registration->point_count == strokes.points().size())
    return published_registration;
  auto state = std::make_shared<RegistrationState>();
  state->drawn = strokes.trace();
  state->point_count = strokes.points().size();
  state->excluded = strokes.excluded();
  state->strokes_were_tried = fit.tried(strokes);
  state->online = online;
  state->in_force = ledger.in_force();
  state->change_count = ledger.change_count();
  state->history = ledger.entries();
  state->entry_in_force = ledger.entry_in_force();
  state->is_chosen = ledger.is_chosen();
  state->alarm = ledger.alarm();
  state->touches = ledger.touches();
  state->bone_is_ready = outcome != nullptr && outcome->bone_is_ready;
  state->is_fitting = fit.is_under_way();
  if (outcome != nullptr) state->bone_trouble = outcome->failure;
  state->set_aside_count = set_aside_count;
  published_registration = std::move(state);
  return published_registration;
}

}  // namespace arthronaut::operation
