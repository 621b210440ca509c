#include "app/navigate/live_words.h"

#include "app/widgets/controls.h"
#include "navigation/registration/verdict/confidence.h"
#include "navigation/sources/camera_modes.h"

namespace arthronaut::navigate {

using operation::NextAction;
using operation::Standing;

std::string words_of(NextAction action) {
  switch (action) {
    case NextAction::PlanTunnel:
      return "plan the tunnel (F1)";
    case NextAction::StartSource:
      return "start a source";
    case NextAction::ConfirmTimeOut:
      return "time-out: confirm patient, side, plan and tools";
    case NextAction::ShowWorldMarker:
      return "bring the bone marker into view";
    case NextAction::Draw:
      return "let the probe draw";
    case NextAction::GoOnDrawing:
      return "draw on the bone with the probe";
    case NextAction::RegisterStrokes:
      return "register what was touched";
    case NextAction::WaitForRegistration:
      return "wait for the registration";
    case NextAction::CheckWorldMarker:
      return "check the world marker: touch the control point";
    case NextAction::ConfirmByTouch:
      return "touch the bone once: confirms the registration";
    case NextAction::RegisterAnew:
      return "register anew: let the probe draw";
    case NextAction::TakePlanOver:
      return "the plan was edited: take it over";
    case NextAction::VerifyByTouch:
      return "touch a place you know";
    case NextAction::SetControlPoint:
      return "set the control point: touch a mark on the bone";
    case NextAction::CheckControlPoint:
      return "touch the control point again";
    case NextAction::CheckGuide:
      return "check the guide: hold its tip on the control point";
    case NextAction::BringGuide:
      return "take the guide";
    case NextAction::FollowBullseye:
      return "follow the bullseye";
    case NextAction::RecordDrilled:
      return "press when the tunnel is drilled";
    case NextAction::Finish:
      return "take the world marker out; done";
  }
  return "";
}

namespace {
bool needs_pictures(NextAction action) {
  switch (action) {
    case NextAction::ShowWorldMarker:
    case NextAction::Draw:
    case NextAction::GoOnDrawing:
    case NextAction::CheckWorldMarker:
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
    case NextAction::CheckGuide:
    case NextAction::BringGuide:
    case NextAction::FollowBullseye:
      return true;
    default:
      return false;
  }
}
}  // namespace

std::string words_without_pictures(theatre::SourceTrouble trouble, NextAction action,
                                   const std::optional<Eigen::Vector2i>& changed_to_px) {
  if (!needs_pictures(action)) return "";
  switch (trouble) {
    case theatre::SourceTrouble::NoPicture:
      // Somebody has to do something about it: no waiting ends that. What it was stands in the panel.
      return changed_to_px ? "format changed to " + sources::size_in_words(*changed_to_px) +
                                 ": set the processor back, or choose the camera (K)"
                           : "look after cable and camera: no picture comes";
    case theatre::SourceTrouble::Plain:
      return "look after light and camera: the picture is plain";
    case theatre::SourceTrouble::Frozen:
      return "look after cable and camera: the picture is frozen";
    default:
      return "";
  }
}

std::string words_beside_no_picture(theatre::SourceTrouble trouble, NextAction action) {
  if (action != NextAction::ConfirmTimeOut && action != NextAction::RecordDrilled &&
      action != NextAction::Finish)
    return "";
  switch (trouble) {
    case theatre::SourceTrouble::NoPicture:
      return "no picture comes; ";
    case theatre::SourceTrouble::Plain:
      return "the picture is plain; ";
    case theatre::SourceTrouble::Frozen:
      return "the picture is frozen; ";
    case theatre::SourceTrouble::Torn:
      return "the picture is torn; ";
    default:
      return "";
  }
}

std::string why_not_live(const theatre::LiveState& live) {
  if (live.phase == theatre::LiveState::Phase::Failed) return live.message;
  const bool is_of_now = live.trouble == theatre::SourceTrouble::None ||
                         live.trouble == theatre::SourceTrouble::Repeated ||
                         live.trouble == theatre::SourceTrouble::Lost;
  return live.phase != theatre::LiveState::Phase::Running || is_of_now ? "" : live.trouble_words;
}

std::string words_of(Repeat repeat, operation::Step step, bool is_shown, theatre::SourceTrouble trouble,
                     const std::optional<Eigen::Vector2i>& changed_to_px) {
  const auto wanted = [&] {
    switch (repeat) {
      case Repeat::TouchControl:
        return NextAction::CheckControlPoint;
      case Repeat::Draw:
        return NextAction::Draw;
      case Repeat::Touch:
        return NextAction::VerifyByTouch;
      default:
        return is_shown ? NextAction::FollowBullseye : NextAction::StartSource;  // by no picture
    }
  }();
  const std::string wait = words_without_pictures(trouble, wanted, changed_to_px);
  if (!wait.empty()) return wait;
  return is_shown ? words_of(wanted) : words_of(repeat, step);
}

namespace {
constexpr const char* kLooksOtherwise = "bone looks otherwise: ";
constexpr const char* kWasOutOfSight = "marker was out of sight: ";
}  // namespace

std::string words_of_verifying(const operation::OperationState& state) {
  if (asks_for_places(state.control_point_due)) {
    const bool looks = state.control_point_due == operation::ControlPointDue::CannotCheckLooks;
    return (looks ? kLooksOtherwise : kWasOutOfSight) +
           ("touch places that you know, " + std::to_string(state.places_in_doubt)) + " to go";
  }
  const std::string words = words_of(NextAction::VerifyByTouch);
  const int missing = state.registration->touches.places_to_verify();
  const bool counts = state.verification != operation::Verification::ByTouches && missing > 0;
  return counts ? words + ", " + std::to_string(missing) + " to go" : words;
}

std::string words_of_registering_anew(const operation::OperationState& state) {
  if (state.registration->in_force.standing != Standing::Stands) return words_of(NextAction::RegisterAnew);
  return "touches lie off the bone: draw more, or hold Shift+T to forget them";
}

std::string words_of_checking(const operation::OperationState& state) {
  using operation::ControlPointDue;
  const std::string words = words_of(NextAction::CheckControlPoint);
  switch (state.control_point_due) {
    case ControlPointDue::CheckBeforeDrilling:
      return "before drilling: " + words;
    case ControlPointDue::CheckAfterLoss:
      return kWasOutOfSight + words;
    case ControlPointDue::CheckLooks:
      return kLooksOtherwise + words;
    case ControlPointDue::CheckShift:
      return "it lay elsewhere: " + words;
    case ControlPointDue::None:
    case ControlPointDue::Set:
    case ControlPointDue::CannotCheckLooks:
    case ControlPointDue::CannotCheckLoss:
      return words;
  }
  return words;
}

std::string place_anew_words(operation::WayOut way_out) {
  return way_out == operation::WayOut::StrokesAnew ? "touches lie off the bone: clear all, then draw anew"
                                                   : "check, then place the marker anew";
}

namespace {
std::string why_no_touch(const operation::OperationState& state) {
  // What was refused of a source that has ended since is no news.
  if (!state.has_source && state.touch_refusal != operation::TouchRefusal::NoSource) return "";
  switch (state.touch_refusal) {
    case operation::TouchRefusal::None:
      return "";
    case operation::TouchRefusal::NoSource:
      return "no pictures come";
    case operation::TouchRefusal::NoControlPoint:
      return "no control point yet";
    case operation::TouchRefusal::TipUnknown:
      return state.touch_is_of_guide ? "guide's tip not seen" : "probe's tip not seen";
    case operation::TouchRefusal::TipMoves:
      // Who has put the probe aside and aims the guide asks for no touch any more.
      if (!state.touch_is_of_guide && !state.frame.tip_is_valid && state.frame.guidance.is_valid()) return "";
      return state.touch_is_of_guide ? "the guide moves" : "the probe moves";
    case operation::TouchRefusal::MarkerIsSeen:
      return "";  // no touch was asked for
    case operation::TouchRefusal::TimeOutDue:
      return "the time-out comes first";
  }
  return "";
}
}  // namespace

std::string refusal_notice(const theatre::LiveState& live, double now_s) {
  constexpr double kReadable_s = 8;
  if (now_s - live.refused_s > kReadable_s) return "";
  if (!live.refusal.words.empty()) return live.refusal.words;
  if (live.operation->has_source && live.operation->touch_refusal == operation::TouchRefusal::MarkerIsSeen)
    return "marker not out: it is still seen";
  const std::string why = why_no_touch(*live.operation);
  if (why.empty()) return "";
  return (live.operation->touch_is_of_guide ? "guide not checked: " : "no touch: ") + why;
}

namespace {
// Short: with its reason it has four lines on the smallest screen.
std::string words_of(operation::WayOut way_out) {
  switch (way_out) {
    case operation::WayOut::None:
      return "";
    case operation::WayOut::ControlPoint:
      return "Touch the control point again, or clear the points (C)";
    case operation::WayOut::StrokesAnew:
      return "On soft tissue: forget them (Shift+T); else clear (C)";
    case operation::WayOut::MarkerPlacedAnew:
      return "Fix the marker, clear the points (C) and draw anew";
  }
  return "";
}
}  // namespace

Trouble trouble_of(const operation::RegistrationState& registration) {
  const operation::RegistrationInForce& in_force = registration.in_force;
  const std::string why = in_force.registration != nullptr && !in_force.registration->reasons.empty()
                              ? in_force.registration->reasons.front()
                              : "";
  switch (in_force.standing) {
    case Standing::None:
    case Standing::Stands:
      return {};
    case Standing::NotReliable:
      return {"Registration not reliable", why};
    case Standing::Void:
      return {"Registration void",
              why + (in_force.can_be_confirmed ? ". Touch the bone with the probe once (T) to confirm it"
                                               : ". Register anew")};
    case Standing::Alarm:
      return {"World marker may have moved", why + ". " + words_of(registration.way_out())};
    case Standing::InDoubt:
      // By drawing more the strokes get no other size.
      return {"Registration in doubt",
              why + (in_force.registration != nullptr &&
                             registration::differ_in_size(in_force.registration->stroke_scale)
                         ? ". Measure the printed markers; calibrate camera and probe anew"
                         : ". Draw more, or exclude the strokes that are wrong")};
  }
  return {};
}

Trouble trouble_of(const operation::GuideCheckState& guide, const std::string& name) {
  switch (guide.standing) {
    case operation::GuideStanding::NotAsked:
    case operation::GuideStanding::Checked:
    case operation::GuideStanding::Trusted:
      return {};
    case operation::GuideStanding::Due:
      return {"Guide not checked",
              "Nobody measured where the " + name + " ends: hold its tip on the control point (A)"};
    case operation::GuideStanding::Off:
      return {"Guide is off", "Its tip is " + widgets::fixed(guide.error_mm, 1) +
                                  " mm from the control point: measure the " + name + " in Set up"};
  }
  return {};
}

Trouble trouble_of_end(const operation::OperationState& state) {
  const bool may_be_drilled = state.registration->in_force.standing == Standing::Stands && state.plan &&
                              state.drilled.outcome == operation::DrilledState::Outcome::NotSaid;
  // What the pedal asks for is not asked for a second time by another key; the other case is a step back.
  if (may_be_drilled && state.next_action == NextAction::RecordDrilled)
    return {"The pictures have ended",
            "Nothing guides. If it is not drilled: a step back (Page up), then other pictures"};
  // What was drilled in no picture of a simulation was not drilled.
  const bool is_simulated = state.source != nullptr && state.source->kind == sources::SourceKind::Simulation;
  return {"The pictures have ended",
          may_be_drilled && !is_simulated
              ? "Nothing guides. Go on with others; if the tunnel is drilled already, say so (hold J)"
              : "This is the last one: nothing guides"};
}

Trouble trouble_of(const lens::LensObservation& lens) {
  using lens::MarkState;
  if (lens.zoom_or_slip)
    return {"Zoom changed or coupler slipped",
            "The round view has another size or place than at the calibration: set the zoom back, or "
            "calibrate again"};
  switch (lens.mark) {
    case MarkState::Found:
      return {};
    case MarkState::NoCircle:
      return {"Lens mark not found", "The round border is not seen: bring the whole view into the picture"};
    case MarkState::Dark:
      return {"Lens mark not found", "Too dark beside the border: give more light"};
    case MarkState::Covered:
      return {"Lens mark not found", "Something covers the mark: move the instrument from the border"};
    case MarkState::Ambiguous:
      return {"Lens mark not found", "Two marks look alike: turn the lens a little"};
    case MarkState::NotSeen:
      return {"Lens mark not found", "The border has no mark: is this the scope of the calibration?"};
  }
  return {};
}

}  // namespace arthronaut::navigate
