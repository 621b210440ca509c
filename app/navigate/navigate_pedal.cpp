// What the pedals do in theatre: one for the next step, one for the way back. What is said to come next and
// what a press does stand together here, so that they stay the same.
#include <algorithm>
#include <utility>

#include "app/navigate/navigate_view.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

using operation::NextAction;
using Phase = theatre::LiveState::Phase;

namespace {
constexpr double kReadable_s = 1.5;  // of what a press would say for the surgeon
constexpr const char* kWrongMedium = "wrong medium: hold Esc, then M for the other one, then start again";
}  // namespace

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
  started_.goes_on_with(sources::source_kind_from_text(left->found.header.source_kind));
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

NextAction NavigateView::action_now() const {
  const NextAction action = live_->operation->next_action;
  // What is touched is touched in pictures: once they have ended, others come first.
  const bool touches = action == NextAction::CheckWorldMarker && !registration().must_be_found_anew();
  return touches && live_->phase != Phase::Starting && !is_running() ? NextAction::StartSource : action;
}

std::string NavigateView::words_of_repeat(operation::Step step) const {
  const Repeat repeat = repeat_of(step);
  if (!is_running()) return words_of(repeat, step);
  const bool is_shown = repeat == Repeat::ShowGuide && finishes();
  return is_shown && is_in_wrong_medium() ? kWrongMedium
                                          : navigate::words_of(repeat, step, is_shown, live_->trouble);
}

std::string NavigateView::next_step() {
  if (model_ == nullptr) return "open a case";
  if (resume_.is_looking()) return "wait: the case's last operation is looked for";
  if (cameras_.is_open()) {
    const auto pictures = cameras_.chosen();
    if (cameras_.chosen_does_not_answer()) return pictures->name + " does not answer: open it all the same";
    return pictures ? "open " + pictures->name : "type the address of a stream, then Enter";
  }
  if (left_behind() != nullptr) return "resume the operation that was left";
  if (const std::string own = lent_step(); !own.empty()) return own;
  if (choices_.looked_at) return words_of_repeat(*choices_.looked_at);
  const NextAction action = action_now();
  if (const auto offered = tunnel_to_choose()) return words_of_choosing(*offered);
  if (choices_.goes_to_other_bone) return "wait: the pictures end";
  if (finishes()) {
    const auto bones = finished_bones();
    return words_of(finish_action(bones, choices_.bone, is_under_way(*live_)), bones, choices_.bone);
  }
  const auto guided = bones_.guided(choices_.bone);
  if (!guided) return words_of(NextAction::PlanTunnel);
  if (waits_for_take_over() && guided->bundle != norms::Bundle::Whole)
    return "take over the tunnel " + tunnels::name_of(*guided);
  if (awaits_picture(*live_))
    return started_.stops_once_open() ? "wait: it stops once it is open" : "wait for the first picture";
  if (is_in_wrong_medium()) return kWrongMedium;
  if (const std::string wait = words_without_pictures(); !wait.empty()) return wait;
  const std::string beside = is_running() ? words_beside_no_picture(live_->trouble, action) : "";
  if (takes_guide_in_simulation()) return "take the guide (simulation)";
  if (action == NextAction::CheckWorldMarker && registration().must_be_found_anew())
    return place_anew_words(registration().way_out());
  const std::string hand = words_of_simulated_hand(action);
  if (action == NextAction::VerifyByTouch) return words_of_verifying(*live_->operation) + hand;
  if (action == NextAction::CheckControlPoint) return words_of_checking(*live_->operation) + hand;
  if (action == NextAction::RegisterAnew) return words_of_registering_anew(*live_->operation);
  if (action == NextAction::RecordDrilled && guided->bundle != norms::Bundle::Whole)
    return beside + "when the tunnel " + tunnels::name_of(*guided) + " is drilled: say so";
  const bool starts = action == NextAction::StartSource || action == NextAction::PlanTunnel;
  if (!starts) return beside + words_of(action) + hand;
  if (must_set_up()) return "calibrate camera and tools in Set up";
  const bool have_ended = live_->phase == Phase::Ended && live_->picture != nullptr;
  return (have_ended ? "the pictures have ended: " : "") + words_of_start();
}

std::string NavigateView::missing_now(const Rail& rail) {
  const bool asks_otherwise = model_ == nullptr || cameras_.is_open() || left_behind() != nullptr ||
                              resume_.is_looking() || choices_.goes_to_other_bone || !lent_step().empty();
  if (asks_otherwise) return "";
  if (choices_.looked_at) {
    const RailStep& step = rail[static_cast<std::size_t>(*choices_.looked_at)];
    if (step.verdict == tunnels::PlanCheck::Verdict::Fine) return hindrance_of(step, true);
    return step.step == operation::Step::Tools
               ? "nobody measured the probe or the guide: they are as designed"
               : words_of_verdict();
  }
  if (finishes()) return "";
  // What a press would put in force, before it is pressed.
  const bool shows_nothing =
      awaits_picture(*live_) || is_in_wrong_medium() || !words_without_pictures().empty();
  if (waits_for_take_over() && !shows_nothing) return words_of_edited_plan();
  const bool has_pictures = is_running() && !awaits_picture(*live_) && words_without_pictures().empty();
  if (has_pictures && !is_in_wrong_medium())
    if (const std::string words = hindrance_of(*live_->operation, live_->trouble); !words.empty())
      return words;
  const std::string words = hindrance_of(rail[static_cast<std::size_t>(step_of_now(rail))], false);
  const auto& source = live_->operation->source;
  // Before anything is begun by it; after that the sign in the row of steps says it.
  if (words.empty() && source == nullptr && judged_.verdict().is_wrong()) return words_of_verdict();
  return words.empty() && source != nullptr && operation::has_camera_of_simulator(*source)
             ? navigate::words_of(Missing::CameraOfScope)
             : words;
}

// What is confirmed, recorded or said to be out stands in the record for good. It has to have been asked on
// the screen for long enough to be read: a second press of a foot that slipped, and one that was meant for
// what stood there before, say nothing.
bool NavigateView::was_read() {
  return next_step() + words_of_edited_plan() == choices_.next &&
         theatre::LiveOperation::now_s() - choices_.next_since_s >= kReadable_s;
}

void NavigateView::take_next_step() {
  if (cameras_.is_open()) {
    if (const auto pictures = cameras_.chosen()) start_live(*pictures);
    return;
  }
  if (resume_.is_looking()) return;
  // What nobody has seen nobody answers: the menu lies over its card.
  if (choices_.shows_menu && question() != Question::None) {
    choices_.shows_menu = false;
    return;
  }
  if (left_behind() != nullptr) return resume();
  if (!lent_step().empty()) return;
  if (choices_.looked_at) {
    if (stays_there()) return;
    return repeat_step(*std::exchange(choices_.looked_at, std::nullopt));
  }
  if (choices_.goes_to_other_bone) return;
  if (const auto offered = tunnel_to_choose()) {
    if (was_read()) choose_tunnel(offered->bundle);
    return;
  }
  if (finishes()) return finish_step(finish_action(finished_bones(), choices_.bone, is_under_way(*live_)));
  if (awaits_picture(*live_) || is_in_wrong_medium() || !words_without_pictures().empty()) return;
  if (!bones_.guided(choices_.bone)) {
    if (!bones_.must_choose(choices_.bone)) go_elsewhere_(Elsewhere::Plan);
    return;
  }
  if (waits_for_take_over()) {
    if (was_read()) ask(operation::TakePlanOver{});
    return;
  }
  switch (action_now()) {
    case NextAction::StartSource:
    case NextAction::PlanTunnel:  // of an operation that was not told yet of the plan that is there
      return must_set_up() ? go_elsewhere_(Elsewhere::SetUp) : start_same_kind();
    case NextAction::ConfirmTimeOut:
      if (was_read()) ask(operation::ConfirmTimeOut{!patient_.empty()});
      return;
    case NextAction::Draw:
    case NextAction::RegisterAnew:
      return ask(operation::Draw{true});
    case NextAction::RegisterStrokes:
      return ask(operation::RegisterStrokes{});
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
      return take_touch(false);
    case NextAction::CheckWorldMarker:
      if (!registration().must_be_found_anew()) return take_touch(true);
      if (was_read()) find_anew();
      return;
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
      return take_touch(true);
    case NextAction::CheckGuide:
      return ask(operation::CheckGuide{});
    case NextAction::RecordDrilled:
      if (was_read()) ask(operation::TunnelDrilled{});
      return;
    case NextAction::BringGuide:
      if (takes_guide_in_simulation()) start_simulation(SimulatedPart::Drill);
      return;
    case NextAction::TakePlanOver:  // answered above
    case NextAction::ShowWorldMarker:
    case NextAction::GoOnDrawing:
    case NextAction::WaitForRegistration:
    case NextAction::FollowBullseye:
    case NextAction::Finish:
      return;  // what is to be done is not done by a pedal
  }
}

// Both void all that was found. That the marker was placed anew is recorded where something says so.
void NavigateView::find_anew() {
  if (registration().way_out() == operation::WayOut::StrokesAnew) return ask(operation::ClearStrokes{});
  ask(operation::MarkerPlacedAnew{});
}

bool NavigateView::pedal_acts() {
  if (model_ == nullptr || resume_.is_looking() || choices_.goes_to_other_bone) return false;
  if (cameras_.is_open()) return cameras_.chosen().has_value();
  if (choices_.shows_menu && question() != Question::None) return true;  // it shows the question
  if (left_behind() != nullptr) return true;
  if (!lent_step().empty()) return false;
  if (choices_.looked_at) return !stays_there() && repeat_of(*choices_.looked_at) != Repeat::NothingNow;
  if (tunnel_to_choose()) return was_read();
  if (finishes())
    return finish_action(finished_bones(), choices_.bone, is_under_way(*live_)) != FinishAction::Nothing &&
           was_read();
  if (awaits_picture(*live_) || is_in_wrong_medium() || !words_without_pictures().empty()) return false;
  if (waits_for_take_over()) return was_read();
  switch (action_now()) {
    case NextAction::BringGuide:
      return takes_guide_in_simulation();
    case NextAction::ConfirmTimeOut:
    case NextAction::RecordDrilled:
      return was_read();
    case NextAction::CheckWorldMarker:
      return !registration().must_be_found_anew() || was_read();
    case NextAction::ShowWorldMarker:
    case NextAction::GoOnDrawing:
    case NextAction::WaitForRegistration:
    case NextAction::FollowBullseye:
    case NextAction::Finish:
      return false;
    default:
      return true;
  }
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
  const bool is_said_drilled = plan && choices_.is_drilled(*live_->operation, *plan);
  return navigate::repeat_of(step, *live_->operation, is_said_drilled);
}

// At the step that was gone back to: its guide is shown already, in place of the check list, or what a press
// would record has not been read.
bool NavigateView::stays_there() {
  const Repeat repeat = repeat_of(*choices_.looked_at);
  return (repeat == Repeat::ShowGuide && finishes() && is_running()) ||
         (repeat == Repeat::NotDrilled && !was_read());
}

void NavigateView::repeat_step(operation::Step step) {
  switch (repeat_of(step)) {
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

// Nothing that is asked in it, the time-out with it, can be answered.
bool NavigateView::is_in_wrong_medium() const {
  return is_running() && live_->operation->medium.fit == pipeline::MediumFit::Contradicts;
}

std::string NavigateView::words_without_pictures() const {
  const NextAction action = live_->operation->next_action;
  const bool needs_none = action == NextAction::CheckWorldMarker && registration().must_be_found_anew();
  return is_running() && !needs_none
             ? navigate::words_without_pictures(live_->trouble, action, live_->trouble_words)
             : "";
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
  context.is_drilled = finishes();
  const auto was_measured = [](const FinishedTunnel& tunnel) { return tunnel.measured.has_value(); };
  context.was_measured = context.is_drilled && std::ranges::all_of(finished.front().tunnels, was_measured);
  const auto& plan = live_->operation->plan;
  const auto& kind = started_.kind();
  context.was_verified = kind && plan && choices_.verified.contains({*kind, plan->tunnel.key()});
  context.marker_is_out = kind && choices_.markers_out.contains({*kind, choices_.bone});
  return context;
}

// What came of it is read in large, also once the step is done; but for a guide that is in the hand.
void NavigateView::take_touch(bool is_control_point) {
  if (theatre::LiveOperation::now_s() - choices_.guidance_seen_s > kGuideAway_s)
    choices_.layout = NavigateLayout::Register;
  if (is_control_point)
    ask(operation::TouchControlPoint{});
  else
    ask(operation::TakeTouch{});
}

}  // namespace arthronaut::navigate
