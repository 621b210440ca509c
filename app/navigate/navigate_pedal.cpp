// What the pedals do in theatre: one for the next step, one for the way back. Which step that is, is decided
// in pedal_step.h.
#include <algorithm>
#include <utility>

#include "app/navigate/navigate_view.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

using operation::NextAction;
using Phase = theatre::LiveState::Phase;

const LeftBehind* NavigateView::left_behind() {
  const bool has_begun = live_->phase != Phase::NoSource || live_->operation->resumed != nullptr;
  return has_begun ? nullptr : resume_.of(choices_.bone);
}

bool NavigateView::asks_for_front() {
  const bool has_begun = live_->phase != Phase::NoSource || live_->operation->resumed != nullptr;
  const auto bone = has_begun ? std::nullopt : resume_.cut_off(std::chrono::system_clock::now());
  if (bone && *bone != choices_.bone) take_other_bone();
  return bone && *bone == choices_.bone;
}

// One step. What is brought back guides nothing until a touch; the source is the next step, of the same kind.
void NavigateView::resume() {
  const LeftBehind* const left = left_behind();
  if (left == nullptr) return;
  started_.goes_on_with(left->found.header.source_kind);
  // Who resumes it was told by which tunnel.
  if (const auto& was = left->found.operation.plan;
      was && bones_.guided(choices_.bone) != was->tunnel.key() && bones_.planned(was->tunnel.key()))
    bones_.choose(was->tunnel.key());
  ask(left->found.operation);
  notice_ = left->found.operation.registration
                ? "Resumed: what guided before guides again after one touch on the bone"
                : "Resumed without a registration: " + left->found.refusal;
  log::info("resumed: session " + left->found.operation.session);
  resume_.answer(choices_.bone);
}

void NavigateView::decline_resume() {
  if (const LeftBehind* const left = left_behind())
    log::info("not resumed: session " + left->found.operation.session);
  try {
    resume_.decline(choices_.bone);
    notice_ = "Not resumed: Review (F3) takes it up again";
  } catch (const IoError& error) {
    notice_ = error.what();
  }
}

PedalContext NavigateView::pedal_context() {
  PedalContext context;
  if (model_ == nullptr) return context;
  context.has_case = true;
  context.bone = choices_.bone;
  context.chooses_pictures = cameras_.is_open();
  if (const auto pictures = cameras_.is_open() ? cameras_.chosen() : std::nullopt)
    context.pictures = pictures->name;
  context.pictures_do_not_answer = cameras_.is_open() && cameras_.chosen_does_not_answer();
  context.searches = resume_.is_looking();
  context.was_left = left_behind() != nullptr;
  context.exercise = lent_step();
  context.goes_to_other_bone = choices_.goes_to_other_bone;
  context.looked_at = choices_.looked_at;
  if (choices_.looked_at) context.repeat = repeat_of(*choices_.looked_at);
  context.bones = finished_bones();
  context.offered = tunnel_to_choose();
  context.guided = bones_.guided(choices_.bone);
  context.must_choose = bones_.must_choose(choices_.bone);
  context.edited_verdict = judged_edited_.verdict().worst();
  context.stops_once_open = started_.stops_once_open();
  context.can_take_guide = is_running() && holds_simulated_probe() && can_simulate();
  if (is_running() && holds_simulated_probe()) context.hand_rests = resting_.rests();
  context.may_change_medium = may_change_medium();
  context.must_set_up = must_set_up();
  context.start = words_of_start();
  return context;
}

std::string NavigateView::missing_now(const PedalStep& step, const Rail& rail) {
  using Kind = PedalStep::Kind;
  switch (step.kind) {
    case Kind::OpenCase:
    case Kind::OpenPictures:
    case Kind::TypeAddress:
    case Kind::WaitForSearch:
    case Kind::Resume:
    case Kind::Exercise:
    case Kind::WaitForEnd:
      return "";
    case Kind::Finish:
      return why_not_live(*live_);
    case Kind::GoBackTo: {
      const RailStep& looked_at = rail[static_cast<std::size_t>(step.step)];
      if (looked_at.verdict == tunnels::PlanCheck::Verdict::Fine) return hindrance_of(looked_at, true);
      return step.step == operation::Step::Tools
                 ? "nobody measured the probe or the guide: they are as designed"
                 : words_of_verdict();
    }
    case Kind::TakePlanOver:  // what a press would put in force, before it is pressed
      return words_of_edited_plan();
    case Kind::WaitForPicture:
    case Kind::ChangeMedium:
    case Kind::WaitForPictures:
      break;
    default:
      if (!is_running()) break;
      if (step.kind == Kind::Act && step.action == operation::NextAction::ConfirmTimeOut)
        if (const std::string words = why_not_live(*live_); !words.empty()) return words;
      if (const std::string words = hindrance_of(*live_->operation, live_->trouble); !words.empty())
        return words;
  }
  const std::string words = hindrance_of(rail[static_cast<std::size_t>(step_of_now(rail))], false);
  const auto& source = live_->operation->source;
  // Before anything is begun by it; after that the sign in the row of steps says it.
  if (words.empty() && source == nullptr && judged_.verdict().is_wrong()) return words_of_verdict();
  return words.empty() && source != nullptr && operation::has_camera_of_simulator(*source)
             ? navigate::words_of(Missing::CameraOfScope)
             : words;
}

bool NavigateView::acts_now(const PedalStep& step) const {
  const bool was_read =
      step == choices_.pedal && choices_.was_asked_for(theatre::LiveOperation::now_s(), kReadable_s);
  return acts(step) && (!must_be_read(step) || was_read);
}

void NavigateView::take_next_step() {
  // What nobody has seen nobody answers: the menu lies over its card.
  if (covers_question()) {
    choices_.shows_menu = false;
    return;
  }
  const PedalStep step = pedal_step(*live_, pedal_context());
  if (!acts_now(step)) return;
  using Kind = PedalStep::Kind;
  switch (step.kind) {
    case Kind::OpenPictures:
      return start_live(*cameras_.chosen());
    case Kind::Resume:
      return resume();
    case Kind::GoBackTo:
      choices_.looked_at.reset();
      return repeat_step(step.repeat);
    case Kind::ChooseTunnel:
      return choose_tunnel(step.tunnel->bundle);
    case Kind::Finish:
      return finish_step(step.finish);
    case Kind::ChangeMedium:
      return take_other_medium();
    case Kind::PlanTunnel:
      return go_elsewhere_(Elsewhere::Plan);
    case Kind::TakePlanOver:
      return ask(operation::TakePlanOver{});
    case Kind::TakeGuide:
      return start_simulation(SimulatedPart::Drill);
    case Kind::FindAnew:
      return find_anew();
    case Kind::SetUp:
      return go_elsewhere_(Elsewhere::SetUp);
    case Kind::Start:
      return start_same_kind();
    case Kind::Act:
      return act(step.action);
    default:
      return;  // it does not act: see acts()
  }
}

void NavigateView::act(operation::NextAction action) {
  switch (action) {
    case NextAction::ConfirmTimeOut:
      return ask(operation::ConfirmTimeOut{!patient_.empty()});
    case NextAction::Draw:
    case NextAction::RegisterAnew:
      return ask(operation::Draw{true});
    case NextAction::RegisterStrokes:
      return ask(operation::RegisterStrokes{});
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
      return take_touch(false);
    case NextAction::CheckWorldMarker:
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
      return take_touch(true);
    case NextAction::CheckGuide:
      return ask(operation::CheckGuide{});
    case NextAction::RecordDrilled:
      return ask(operation::TunnelDrilled{});
    default:
      return;  // a step of another kind, or none that a pedal does
  }
}

// The simulated scope has one medium, and a lent source is not ended here.
bool NavigateView::may_change_medium() const {
  const auto& source = live_->operation->source;
  return is_running() && !lent_ && source != nullptr && source->kind != sources::SourceKind::Simulation;
}

// What a source looks through belongs to it from its first picture on: they end, and the next ones, which the
// pedal begins, look through the other medium.
void NavigateView::take_other_medium() {
  if (!may_change_medium()) return;
  const pipeline::MediumVerdict& seen = live_->operation->medium;
  choices_.saline = seen.fit == pipeline::MediumFit::Contradicts
                        ? is_fluid(seen.other_index)
                        : !is_fluid(live_->operation->source->pipeline.refractive_index);
  end_source();
  notice_ = std::string("The next pictures look through ") + (choices_.saline ? "saline" : "air");
}

// Both void all that was found. That the marker was placed anew is recorded where something says so.
void NavigateView::find_anew() {
  if (registration().way_out() == operation::WayOut::StrokesAnew) return ask(operation::ClearStrokes{});
  ask(operation::MarkerPlacedAnew{});
}

void NavigateView::take_step_back() {
  if (choices_.shows_menu) {
    choices_.shows_menu = false;
    return;
  }
  if (cameras_.is_open()) return cameras_.close();
  if (depth_.is_open()) return depth_.close();
  // What was offered can be had again: it is in the case, and is offered when the case is opened anew.
  if (left_behind() != nullptr) return decline_resume();
  if (resume_.is_looking() || choices_.goes_to_other_bone || !lent_step().empty()) return;
  choices_.looked_at = step_before(choices_.looked_at.value_or(step_of_now(rail())));
}

Repeat NavigateView::repeat_of(operation::Step step) const {
  const auto& plan = live_->operation->plan;
  const bool is_said_drilled = plan && drilled_as(*plan) != nullptr;
  return navigate::repeat_of(step, *live_->operation, is_said_drilled);
}

void NavigateView::repeat_step(Repeat repeat) {
  switch (repeat) {
    case Repeat::ShowPlan:
      return go_elsewhere_(Elsewhere::Plan);
    case Repeat::ShowSetUp:
      return go_elsewhere_(Elsewhere::SetUp);
    case Repeat::TouchControl:
      return take_touch(true);
    case Repeat::Draw:
      return ask(operation::Draw{true});
    case Repeat::RegisterAnew:
      return ask(operation::RegisterStrokes{});
    case Repeat::Touch:
      return take_touch(false);
    case Repeat::ShowGuide:
      choices_.layout = NavigateLayout::Guide;
      return;
    case Repeat::OtherPictures:
      return start_same_kind();
    case Repeat::NotDrilled:
      return ask(operation::TakeBackDrilled{});
    case Repeat::ShowFinish:
    case Repeat::NothingNow:
      return;
  }
}

bool NavigateView::must_set_up() const {
  if (simulates() || live_->operation->source != nullptr) return false;
  const operation::Step now = step_of_now(rail());
  return now == operation::Step::Calibrate || now == operation::Step::Tools;
}

RailContext NavigateView::rail_context() const {
  RailContext context;
  if (model_ == nullptr) return context;
  context.is_planned = bones_.plan_of(choices_.bone).has_value();
  context.must_choose = bones_.must_choose(choices_.bone);
  context.plan_verdict = judged_.verdict().worst();
  context.simulates = simulates();
  context.has_camera = context.simulates || choices_.has_camera_file;
  context.camera_is_simulated = choices_.has_camera_file && !choices_.has_real_scope;
  context.tools = choices_.tools ? &*choices_.tools : nullptr;
  const auto finished = finished_bones();
  context.is_drilled = finishes(finished, choices_.bone);
  const auto was_measured = [](const FinishedTunnel& tunnel) { return tunnel.measured.has_value(); };
  context.was_measured = context.is_drilled && std::ranges::all_of(finished.front().tunnels, was_measured);
  const auto& plan = live_->operation->plan;
  const operation::DrilledTunnel* const drilled = plan ? drilled_as(*plan) : nullptr;
  context.was_verified = drilled != nullptr && drilled->was_verified;
  context.marker_is_out = marker_is_out(choices_.bone);
  context.other_bone_is_left = std::ranges::any_of(finished, [&](const FinishedBone& bone) {
    return bone.bone != choices_.bone && !(bone.is_drilled() && bone.marker_is_out);
  });
  return context;
}

// What came of it is read in large, also once the step is done; but for a guide that is in the hand.
void NavigateView::take_touch(bool is_control_point) {
  choices_.touch_asked_s = theatre::LiveOperation::now_s();
  if (choices_.touch_asked_s - choices_.guidance_seen_s > kGuideAway_s) choices_.layout.reset();
  if (is_control_point)
    ask(operation::TouchControlPoint{});
  else
    ask(operation::TakeTouch{});
}

}  // namespace arthronaut::navigate
