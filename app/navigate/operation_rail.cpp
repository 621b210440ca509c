#include "app/navigate/operation_rail.h"

#include <algorithm>

namespace arthronaut::navigate {

namespace {

using operation::NextAction;
using operation::OperationState;
using operation::Standing;
using operation::Step;

// What stands, once, for all steps.
struct Known {
  const OperationState& state;
  const RailContext& context;

  [[nodiscard]] const tools::ToolSet* tools() const {
    return state.source != nullptr ? &state.source->pipeline.tools : context.tools;
  }
  [[nodiscard]] bool stands() const {
    return state.registration->in_force.standing == Standing::Stands && !context.marker_is_out;
  }
  // The pictures, of a source that there was.
  [[nodiscard]] bool have_ended() const { return state.source != nullptr && !state.has_source; }
  [[nodiscard]] bool is_drilled() const {
    return context.is_drilled || state.drilled.outcome != operation::DrilledState::Outcome::NotSaid;
  }
  // A tunnel that was measured was guided to, by a registration. One that was only said to be drilled tells
  // nothing of the steps before it.
  [[nodiscard]] bool was_guided_to() const {
    using Outcome = operation::DrilledState::Outcome;
    if (state.drilled.outcome == Outcome::NotSaid) return context.is_drilled && context.was_measured;
    return state.drilled.outcome != Outcome::NoEvidence;
  }
  [[nodiscard]] const tools::Tool* probe() const {  // null: none is known
    if (tools() == nullptr) return nullptr;
    return tools()->find_tool(state.source != nullptr ? state.source->pipeline.probe_name : "probe");
  }
  [[nodiscard]] const tools::Tool* guide() const {  // likewise
    if (tools() == nullptr) return nullptr;
    return tools()->find_tool(state.source != nullptr ? state.source->pipeline.guide_name
                                                      : tools::standard_guide_name(state.bone));
  }
  [[nodiscard]] bool probe_is_known() const { return probe() != nullptr && probe()->tip_mm.has_value(); }
  [[nodiscard]] bool guide_is_known() const { return guide() != nullptr && guide()->axis.has_value(); }
  // The tools are to be real ones.
  [[nodiscard]] bool are_real() const {
    return state.source != nullptr ? state.source->kind != sources::SourceKind::Simulation
                                   : !context.simulates;
  }
};

Missing missing_of_plan(const Known& known) {
  if (known.context.must_choose && !known.state.plan) return Missing::TunnelChoice;
  if (!known.context.is_planned && !known.state.plan) return Missing::Plan;
  return known.state.plan_was_edited ? Missing::PlanTakenOver : Missing::Nothing;
}

Missing missing_of_camera(const Known& known) {
  if (known.state.source == nullptr) {
    if (!known.context.has_camera) return Missing::Camera;
    return known.context.camera_is_simulated && !known.context.simulates ? Missing::CameraOfScope
                                                                         : Missing::Nothing;
  }
  const bool changed = known.state.frame_count > 0 && known.state.frame.lens.zoom_or_slip;
  return changed ? Missing::LensUnchanged : Missing::Nothing;
}

Missing missing_of_marker(const Known& known) {
  const operation::RegistrationState& registration = *known.state.registration;
  if (registration.alarm || known.context.marker_is_out) return Missing::MarkerInPlace;
  // Seen once it is known; that it is lost for a moment is told by what is done then.
  if (registration.point_count > 0 || registration.in_force.registration != nullptr) return Missing::Nothing;
  if (!known.state.has_source) return Missing::Source;
  const bool is_seen = known.state.frame_count > 0 && known.state.frame.world_is_seen();
  return is_seen ? Missing::Nothing : Missing::MarkerInView;
}

Missing missing_of_tools(const Known& known) {
  if (!known.probe_is_known()) return Missing::ProbeTip;
  if (!known.guide_is_known()) return Missing::GuideAxis;
  const auto is_simulated = [](const tools::Tool& tool) {
    return tool.provenance.origin == provenance::Origin::Simulated;
  };
  return known.are_real() && std::ranges::any_of(known.tools()->tools, is_simulated) ? Missing::RealTools
                                                                                     : Missing::Nothing;
}

// Numbers of a drawing, that nobody measured on these tools, are no tick.
tunnels::PlanCheck::Verdict verdict_of_tools(const Known& known) {
  using Verdict = tunnels::PlanCheck::Verdict;
  const tools::Tool *const probe = known.probe(), *const guide = known.guide();
  const bool are_nominal = (probe != nullptr && tools::nominal_parts(*probe).tip) ||
                           (guide != nullptr && tools::nominal_parts(*guide).axis);
  return known.are_real() && are_nominal ? Verdict::Look : Verdict::Fine;
}

// What was registered before patient, knee and plan were confirmed counts from then on.
Missing missing_of_registration(const Known& known) {
  if (!known.stands()) return Missing::Registration;
  return known.state.time_out == operation::TimeOut::Due ? Missing::TimeOut : Missing::Nothing;
}

// What was skipped is not done, however far the operation has gone on without it.
Missing missing_of(operation::Unverified unverified) {
  switch (unverified) {
    case operation::Unverified::Nothing:
      return Missing::Nothing;
    case operation::Unverified::Touches:
      return Missing::Touches;
    case operation::Unverified::ControlPoint:
      return Missing::ControlPoint;
    case operation::Unverified::GuideCheck:
      return Missing::GuideCheck;
  }
  return Missing::Nothing;
}

Missing first_of(std::initializer_list<Missing> wanted) {
  const auto found =
      std::find_if(wanted.begin(), wanted.end(), [](Missing m) { return m != Missing::Nothing; });
  return found == wanted.end() ? Missing::Nothing : *found;
}

// What a step needs before it can be done at all.
Missing condition_of(Step step, const Known& known) {
  const OperationState& state = known.state;
  switch (step) {
    case Step::Plan:
    case Step::Calibrate:
    case Step::Tools:
      return Missing::Nothing;
    case Step::WorldMarker:
      return missing_of_camera(known);
    case Step::Digitise: {
      const Missing probe = known.probe_is_known() ? Missing::Nothing : Missing::ProbeTip;
      // No stroke is taken before it; those of before are there.
      const Missing time_out =
          holds_for_time_out(state) && !known.stands() ? Missing::TimeOut : Missing::Nothing;
      return first_of({missing_of_camera(known), time_out, missing_of_marker(known), probe});
    }
    case Step::Register:
      return state.registration->point_count > 0 || known.stands() ? Missing::Nothing : Missing::Strokes;
    case Step::Verify:
      return missing_of_registration(known);
    case Step::Guide: {
      const Missing time_out =
          state.time_out == operation::TimeOut::Due ? Missing::TimeOut : Missing::Nothing;
      const Missing guide = known.guide_is_known() ? Missing::Nothing : Missing::GuideAxis;
      const Missing registration = missing_of_registration(known);
      const Missing check = state.guide_check.may_guide() ? Missing::Nothing : Missing::GuideCheck;
      const Missing pictures = known.have_ended() ? Missing::Source : Missing::Nothing;
      return first_of({missing_of_plan(known), time_out, guide, registration, check, pictures});
    }
    case Step::Finish:
      return known.is_drilled() ? Missing::Nothing : Missing::Tunnel;
  }
  return Missing::Nothing;
}

// What is not there of the step itself; Nothing: it is done.
Missing rest_of(Step step, const Known& known) {
  const OperationState& state = known.state;
  switch (step) {
    case Step::Plan:
      return missing_of_plan(known);
    case Step::Calibrate:
      // A recording by the simulator's camera goes on, and is never called calibrated.
      if (state.source != nullptr && operation::has_camera_of_simulator(*state.source))
        return Missing::CameraOfScope;
      return missing_of_camera(known);
    case Step::WorldMarker:
      // Taken out at the end it has done its work.
      return known.context.marker_is_out && known.was_guided_to() ? Missing::Nothing
                                                                  : missing_of_marker(known);
    case Step::Tools:
      return missing_of_tools(known);
    case Step::Digitise:
      return known.stands() || known.was_guided_to() ? Missing::Nothing : Missing::Strokes;
    case Step::Register:
      return known.was_guided_to() ? Missing::Nothing : missing_of_registration(known);
    case Step::Verify: {
      // The operation forgets it with the marker.
      if (known.was_guided_to())
        return state.verification == operation::Verification::ByTouches || known.context.was_verified
                   ? Missing::Nothing
                   : Missing::Touches;
      return missing_of(operation::unverified_of(state));
    }
    case Step::Guide:
      if (known.was_guided_to()) return Missing::Nothing;
      return known.is_drilled() ? Missing::Evidence : Missing::Tunnel;
    case Step::Finish:
      if (!known.context.marker_is_out) return Missing::MarkerOut;
      return known.context.other_bone_is_left ? Missing::OtherBone : Missing::Nothing;
  }
  return Missing::Nothing;
}

Step now_of(const Known& known) {
  const OperationState& state = known.state;
  if (known.is_drilled() && (known.context.marker_is_out || !state.plan_was_edited)) return Step::Finish;
  if (missing_of_plan(known) != Missing::Nothing) return Step::Plan;
  if (missing_of_camera(known) != Missing::Nothing) return Step::Calibrate;
  if (state.source == nullptr && missing_of_tools(known) != Missing::Nothing) return Step::Tools;
  // Other pictures are wanted for what is left to do; the marker was found already.
  if (state.next_action == NextAction::StartSource && known.have_ended() && known.stands())
    return state.verification == operation::Verification::NotYet ? Step::Verify : Step::Guide;
  // An operation that was not told yet of the plan that is there starts with its pictures.
  const Step now = operation::step_of(state.next_action);
  return now == Step::Plan ? Step::WorldMarker : now;
}

}  // namespace

Rail rail_of(const OperationState& state, const RailContext& context) {
  const Known known{state, context};
  const Step now = now_of(known);
  Rail rail;
  for (std::size_t i = 0; i < kStepCount; ++i) {
    const Step step = static_cast<Step>(i);
    const Missing condition = condition_of(step, known), rest = rest_of(step, known);
    RailStep& shown = rail[i];
    shown.step = step;
    if (step == now) {
      // A tunnel that stays to be drilled is no fault to be told while it is aimed at.
      shown.state = step == Step::Finish && rest == Missing::Nothing ? StepState::Done : StepState::Now;
      shown.missing = condition != Missing::Nothing ? condition : rest;
    } else if (rest == Missing::Nothing && (condition == Missing::Nothing || known.is_drilled())) {
      shown.state = StepState::Done;
      if (step == Step::Plan) shown.verdict = context.plan_verdict;
      if (step == Step::Tools) shown.verdict = verdict_of_tools(known);
    } else if (condition != Missing::Nothing) {
      shown.missing = condition;
    } else {
      // These three have no condition: what is missing is missing of themselves.
      const bool is_own = step == Step::Plan || step == Step::Calibrate || step == Step::Tools;
      shown.state = is_own ? StepState::Closed : StepState::Open;
      shown.missing = rest;
    }
  }
  return rail;
}

Step step_of_now(const Rail& rail) {
  const auto now =
      std::find_if(rail.begin(), rail.end(), [](const RailStep& s) { return s.state == StepState::Now; });
  return now == rail.end() ? Step::Finish : now->step;
}

std::optional<Step> step_before(Step step) {
  if (step == Step::Plan) return std::nullopt;
  return static_cast<Step>(static_cast<int>(step) - 1);
}

std::string name_of(Step step) {
  constexpr std::array<const char*, kStepCount> kNames{
      "Plan", "Calibrate", "World marker", "Tools", "Digitise", "Register", "Verify", "Guide", "Finish"};
  return kNames[static_cast<std::size_t>(step)];
}

std::string short_name_of(Step step) {
  constexpr std::array<const char*, kStepCount> kNames{"Plan",     "Camera", "Marker", "Tools", "Digitise",
                                                       "Register", "Verify", "Guide",  "Finish"};
  return kNames[static_cast<std::size_t>(step)];
}

std::string words_of(Missing missing) {
  switch (missing) {
    case Missing::Nothing:
      return "";
    case Missing::Plan:
      return "no tunnel is planned in this bone";
    case Missing::TunnelChoice:
      return "which of two tunnels is drilled was not chosen";
    case Missing::PlanTakenOver:
      return "the plan was edited and not taken over";
    case Missing::Camera:
      return "no calibrated camera";
    case Missing::CameraOfScope:
      return "the camera was calibrated on the simulator, not on this scope";
    case Missing::RealTools:
      return "a tool was calibrated on the simulator";
    case Missing::LensUnchanged:
      return "zoom or coupler is not as it was calibrated";
    case Missing::Source:
      return "no pictures";
    case Missing::MarkerInView:
      return "the world marker is not seen";
    case Missing::MarkerInPlace:
      return "the world marker does not sit where it sat";
    case Missing::ProbeTip:
      return "the probe's tip is not known";
    case Missing::GuideAxis:
      return "the guide's axis is not known";
    case Missing::Strokes:
      return "strokes on the bone";
    case Missing::Registration:
      return "no registration stands";
    case Missing::TimeOut:
      return "the time-out is not confirmed";
    case Missing::Touches:
      return "touches that verify";
    case Missing::ControlPoint:
      return "the control point";
    case Missing::GuideCheck:
      return "the guide is not checked";
    case Missing::Tunnel:
      return "the tunnel is not drilled";
    case Missing::Evidence:
      return "nothing shows where it was drilled: by word alone";
    case Missing::MarkerOut:
      return "the world marker is in the bone";
    case Missing::OtherBone:
      return "the other bone is not finished";
  }
  return "";
}

Repeat repeat_of(Step step, const OperationState& state, bool is_said_drilled) {
  const bool may_touch = state.has_source && !holds_for_time_out(state);
  switch (step) {
    case Step::Plan:
      return Repeat::ShowPlan;
    case Step::Calibrate:
    case Step::Tools:
      return Repeat::ShowSetUp;
    case Step::WorldMarker:
      return may_touch && state.registration->touches.has_control_point() ? Repeat::TouchControl
                                                                          : Repeat::NothingNow;
    case Step::Digitise:
      return may_touch && !state.draws ? Repeat::Draw : Repeat::NothingNow;
    case Step::Register:
      return state.registration->point_count > 0 && !state.registration->is_fitting ? Repeat::RegisterAnew
                                                                                    : Repeat::NothingNow;
    case Step::Verify:
      return may_touch ? Repeat::Touch : Repeat::NothingNow;
    case Step::Guide:
      return is_said_drilled || state.drilled.outcome != operation::DrilledState::Outcome::NotSaid
                 ? Repeat::NotDrilled
             : !state.has_source && state.next_action == NextAction::RecordDrilled ? Repeat::OtherPictures
                                                                                   : Repeat::ShowGuide;
    case Step::Finish:
      return Repeat::ShowFinish;
  }
  return Repeat::NothingNow;
}

std::string words_of(Repeat repeat, Step step) {
  switch (repeat) {
    case Repeat::ShowPlan:
      return "go back to the plan";
    case Repeat::ShowSetUp:
      return step == Step::Calibrate ? "calibrate the camera again" : "measure the tools again";
    case Repeat::TouchControl:
      return "touch the control point: does the marker sit where it sat?";
    case Repeat::Draw:
      return "draw more strokes with the probe";
    case Repeat::RegisterAnew:
      return "register all strokes again";
    case Repeat::Touch:
      return "touch one more place that you know";
    case Repeat::ShowGuide:
      return "show the way to the plan";
    case Repeat::OtherPictures:
      return "not drilled yet: go on with other pictures";
    case Repeat::NotDrilled:
      return "take back that the tunnel is drilled";
    case Repeat::ShowFinish:
      return "show the check list";
    case Repeat::NothingNow:
      return "nothing to repeat here now: go on";
  }
  return "";
}

}  // namespace arthronaut::navigate
