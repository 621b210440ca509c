#include "app/navigate/pedal_step.h"

#include "app/navigate/live_words.h"
#include "app/navigate/navigate_display.h"
#include "navigation/camera/medium.h"

namespace arthronaut::navigate {

namespace {

using operation::NextAction;
using Kind = PedalStep::Kind;
using Phase = theatre::LiveState::Phase;

constexpr const char* kWrongMedium = "wrong medium: hold Esc, then M for the other one, then start again";

bool is_running(const theatre::LiveState& live) { return live.phase == Phase::Running; }

// Nothing that is asked in it, the time-out with it, can be answered.
bool is_in_wrong_medium(const theatre::LiveState& live) {
  return is_running(live) && live.operation->medium.fit == pipeline::MediumFit::Contradicts;
}

// What the operation asks for, or pictures where it cannot be done without.
NextAction action_of(const theatre::LiveState& live, bool finds_anew) {
  const NextAction action = live.operation->next_action;
  // What is touched is touched in pictures: once they have ended, others come first.
  const bool touches = action == NextAction::CheckWorldMarker && !finds_anew;
  return touches && live.phase != Phase::Starting && !is_running(live) ? NextAction::StartSource : action;
}

Kind kind_of(const theatre::LiveState& live, const PedalContext& context, NextAction action,
             bool finds_anew) {
  if (!context.has_case) return Kind::OpenCase;
  if (context.chooses_pictures) return context.pictures.empty() ? Kind::TypeAddress : Kind::OpenPictures;
  if (context.searches) return Kind::WaitForSearch;
  if (context.was_left) return Kind::Resume;
  if (!context.exercise.empty()) return Kind::Exercise;
  if (context.goes_to_other_bone) return Kind::WaitForEnd;
  if (context.looked_at) return Kind::GoBackTo;
  if (context.offered) return Kind::ChooseTunnel;
  if (finishes(context.bones, context.bone)) return Kind::Finish;
  if (awaits_picture(live)) return Kind::WaitForPicture;
  if (is_in_wrong_medium(live)) return Kind::ChangeMedium;
  if (is_running(live) && !finds_anew &&
      !words_without_pictures(live.trouble, action, live.changed_to_px).empty())
    return Kind::WaitForPictures;
  if (!context.guided) return Kind::PlanTunnel;
  if (waits_for_take_over(*live.operation)) return Kind::TakePlanOver;
  if (action == NextAction::BringGuide && context.can_take_guide) return Kind::TakeGuide;
  if (finds_anew) return Kind::FindAnew;
  // PlanTunnel: of an operation that was not told yet of the plan that is there.
  if (action != NextAction::StartSource && action != NextAction::PlanTunnel) return Kind::Act;
  return context.must_set_up ? Kind::SetUp : Kind::Start;
}

std::string words_of_choosing(const tunnels::TunnelKey& offered, bool must_choose) {
  // Nothing is chosen before somebody does: the one that a press would choose is named, and how to get the
  // other one.
  const bool is_am = offered.bundle == norms::Bundle::Anteromedial;
  const std::string tunnel = "the tunnel " + tunnels::name_of(offered) + (is_am ? " (1)" : " (2)");
  if (!must_choose) return "then " + tunnel + ", or take the world marker out";
  return "choose " + tunnel + (is_am ? "; V: PL (2)" : "; V: AM (1)");
}

std::string words_of_going_back(const PedalStep& step, const theatre::LiveState& live) {
  if (!is_running(live)) return words_of(step.repeat, step.step);
  return step.is_shown && is_in_wrong_medium(live)
             ? kWrongMedium
             : words_of(step.repeat, step.step, step.is_shown, live.trouble, live.changed_to_px);
}

// Behind what is done by a touch: whether the simulated hand lets it be taken now.
std::string words_of_simulated_hand(NextAction action, const std::optional<bool>& rests) {
  const bool touches = action == NextAction::VerifyByTouch || action == NextAction::ConfirmByTouch ||
                       action == NextAction::SetControlPoint || action == NextAction::CheckControlPoint;
  if (!touches || !rests) return "";
  return *rests ? ". Now: the probe rests" : ". Wait: the probe moves";
}

std::string words_of_acting(const PedalStep& step, const theatre::LiveState& live,
                            const PedalContext& context) {
  const operation::OperationState& state = *live.operation;
  const std::string hand = words_of_simulated_hand(step.action, context.hand_rests);
  if (step.action == NextAction::VerifyByTouch) return words_of_verifying(state) + hand;
  if (step.action == NextAction::CheckControlPoint) return words_of_checking(state) + hand;
  if (step.action == NextAction::RegisterAnew) return words_of_registering_anew(state);
  const std::string beside = is_running(live) ? words_beside_no_picture(live.trouble, step.action) : "";
  if (step.action == NextAction::RecordDrilled && context.guided->bundle != norms::Bundle::Whole)
    return beside + "press when the tunnel " + tunnels::name_of(*context.guided) + " is drilled";
  return beside + words_of(step.action) + hand;
}

std::string words_of_finishing(const PedalStep& step, const theatre::LiveState& live,
                               const PedalContext& context) {
  const std::string beside = step.finish == FinishAction::TakeMarkerOut && is_running(live)
                                 ? words_beside_no_picture(live.trouble, NextAction::Finish)
                                 : "";
  const std::string words = words_of(step.finish, context.bones, step.bone);
  return beside.empty() ? words : beside + words + ": your word alone";
}

}  // namespace

bool finishes(const std::vector<FinishedBone>& bones, bones::BoneKind bone) {
  return !bones.empty() && bones.front().bone == bone && bones.front().is_drilled();
}

bool waits_for_take_over(const operation::OperationState& state) {
  return state.has_source && state.plan_was_edited &&
         (!state.plan || state.next_action == NextAction::TakePlanOver);
}

PedalStep pedal_step(const theatre::LiveState& live, const PedalContext& context) {
  const operation::OperationState& state = *live.operation;
  const bool finds_anew =
      state.next_action == NextAction::CheckWorldMarker && state.registration->must_be_found_anew();
  const NextAction action = action_of(live, finds_anew);
  PedalStep step;
  step.kind = kind_of(live, context, action, finds_anew);
  step.bone = context.bone;
  switch (step.kind) {
    case Kind::GoBackTo:
      step.step = *context.looked_at;
      step.repeat = context.repeat;
      step.is_shown =
          step.repeat == Repeat::ShowGuide && finishes(context.bones, context.bone) && is_running(live);
      break;
    case Kind::ChooseTunnel:
      step.tunnel = context.offered;
      break;
    case Kind::Finish:
      step.finish = finish_action(context.bones, context.bone, is_under_way(live));
      break;
    case Kind::ChangeMedium:
      if (context.may_change_medium) step.medium = camera::medium_to_text(state.medium.other_index);
      break;
    case Kind::TakePlanOver:
      step.plan = state.edited_plan;
      step.plan_verdict = context.edited_verdict;
      break;
    case Kind::WaitForPictures:
      step.action = action;
      break;
    case Kind::Act:
      step.action = action;
      step.plan = state.plan;
      break;
    default:
      break;
  }
  return step;
}

std::string words_of(const PedalStep& step, const theatre::LiveState& live, const PedalContext& context) {
  switch (step.kind) {
    case Kind::OpenCase:
      return "open a case";
    case Kind::OpenPictures:
      return context.pictures_do_not_answer ? context.pictures + " does not answer: open it all the same"
                                            : "open " + context.pictures;
    case Kind::TypeAddress:
      return "type the address of a stream, then Enter";
    case Kind::WaitForSearch:
      return "wait: the case's last operation is looked for";
    case Kind::Resume:
      return "resume the operation that was left";
    case Kind::Exercise:
      return context.exercise;
    case Kind::WaitForEnd:
      return "wait: the pictures end";
    case Kind::GoBackTo:
      return words_of_going_back(step, live);
    case Kind::ChooseTunnel:
      return words_of_choosing(*step.tunnel, context.must_choose);
    case Kind::Finish:
      return words_of_finishing(step, live, context);
    case Kind::WaitForPicture:
      return context.stops_once_open ? "wait: it stops once it is open" : "wait for the first picture";
    case Kind::ChangeMedium:
      return step.medium.empty()
                 ? kWrongMedium
                 : "the pictures look like " + step.medium + ": end them, and take " + step.medium + " next";
    case Kind::WaitForPictures:
      return words_without_pictures(live.trouble, step.action, live.changed_to_px);
    case Kind::PlanTunnel:
      return words_of(NextAction::PlanTunnel);
    case Kind::TakePlanOver:
      if (context.guided->bundle != norms::Bundle::Whole)
        return "take over the tunnel " + tunnels::name_of(*context.guided);
      return live.operation->plan ? words_of(NextAction::TakePlanOver) : "a tunnel was planned: take it over";
    case Kind::TakeGuide:
      return "take the guide (simulation)";
    case Kind::FindAnew:
      return place_anew_words(live.operation->registration->way_out());
    case Kind::SetUp:
      return "calibrate camera and tools in Set up";
    case Kind::Start:
      return (live.phase == Phase::Ended && live.picture != nullptr ? "the pictures have ended: " : "") +
             context.start;
    case Kind::Act:
      return words_of_acting(step, live, context);
  }
  return "";
}

bool acts(const PedalStep& step) {
  switch (step.kind) {
    case Kind::OpenCase:
    case Kind::TypeAddress:
    case Kind::WaitForSearch:
    case Kind::Exercise:
    case Kind::WaitForEnd:
    case Kind::WaitForPicture:
    case Kind::WaitForPictures:
      return false;
    case Kind::ChangeMedium:
      return !step.medium.empty();
    case Kind::OpenPictures:
    case Kind::Resume:
    case Kind::ChooseTunnel:
    case Kind::PlanTunnel:
    case Kind::TakePlanOver:
    case Kind::TakeGuide:
    case Kind::FindAnew:
    case Kind::SetUp:
    case Kind::Start:
      return true;
    case Kind::GoBackTo:
      return !step.is_shown;
    case Kind::Finish:
      return step.finish != FinishAction::Nothing;
    case Kind::Act:
      break;
  }
  switch (step.action) {
    case NextAction::BringGuide:
    case NextAction::ShowWorldMarker:
    case NextAction::GoOnDrawing:
    case NextAction::WaitForRegistration:
    case NextAction::FollowBullseye:
    case NextAction::Finish:
      return false;  // what is to be done is not done by a pedal
    default:
      return true;
  }
}

bool must_be_read(const PedalStep& step) {
  switch (step.kind) {
    case Kind::ChooseTunnel:
    case Kind::Finish:
    case Kind::ChangeMedium:
    case Kind::TakePlanOver:
    case Kind::FindAnew:
      return true;
    case Kind::GoBackTo:
      return step.repeat == Repeat::NotDrilled;
    case Kind::Act:
      return step.action == NextAction::ConfirmTimeOut || step.action == NextAction::RecordDrilled;
    default:
      return false;
  }
}

}  // namespace arthronaut::navigate
