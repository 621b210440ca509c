#include "app/navigate/navigate_display.h"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>

#include "navigation/camera/medium.h"

namespace arthronaut::navigate {

namespace {

using guidance::GuidanceState;
using Phase = theatre::LiveState::Phase;

// "Not seen"; empty while it is tracked.
std::string reason_of_marker(const pipeline::FrameResult& result, int marker_id) {
  std::string words;
  if (!result.outside.bodies.empty()) {
    const tracker::BodyState outside = tracker::state_of(result.outside, marker_id);
    if (outside != tracker::BodyState::Tracked) words = tracker::to_text(outside);
  } else {
    const markers::MarkerState state = pipeline::body_in(result, marker_id).state;
    if (state != markers::MarkerState::Tracked) words = markers::to_text(state);
  }
  if (!words.empty()) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

void tell(NavigateDisplay& display, const Trouble& trouble) {
  display.headline = trouble.headline;
  display.detail = trouble.advice;
}

// Why there is no guidance: as the frame says it, and where it was taken back since, as it is known by now.
GuidanceState cause_of(const operation::OperationState& state) {
  const GuidanceState said = state.frame.guidance.state;
  // Nor can anything be registered before: what is asked first is said first.
  if (said == GuidanceState::NoRegistration && holds_for_time_out(state)) return GuidanceState::NotConfirmed;
  if (said != GuidanceState::Valid && said != GuidanceState::Stale) return said;
  if (state.time_out == operation::TimeOut::Due) return GuidanceState::NotConfirmed;
  switch (state.registration->in_force.standing) {
    case operation::Standing::None:
      return GuidanceState::NoRegistration;
    case operation::Standing::NotReliable:
      return GuidanceState::RegistrationUnreliable;
    default:
      return state.guide_check.may_guide() ? said : GuidanceState::GuideNotChecked;
  }
}

// What is said of the guide, whatever it is, makes no drill with a marker of its own wrong.
bool is_of_guide_alone(GuidanceState state) {
  switch (state) {
    case GuidanceState::Valid:
    case GuidanceState::NoGuide:
    case GuidanceState::GuideLost:
    case GuidanceState::GuideNotChecked:
    case GuidanceState::ErrorUnknown:  // of the bone marker there is no drill
      return true;
    default:
      return false;
  }
}

// Rounded up, and no finer than can be read while it changes.
std::string late_by(double age_s) {
  return age_s < 1 ? widgets::fixed(std::ceil(10 * age_s) / 10, 1) + " s"
                   : widgets::fixed(std::ceil(age_s), 0) + " s";
}

// Of pictures that come, late or not; empty: nothing is wrong with them but that.
std::string headline_of(theatre::SourceTrouble trouble) {
  using theatre::SourceTrouble;
  switch (trouble) {
    case SourceTrouble::Plain:
      return "No picture";
    case SourceTrouble::Frozen:
      return "Picture frozen";
    case SourceTrouble::Torn:
      return "Picture torn";
    case SourceTrouble::Slow:
      return "Pictures come too slowly";
    default:
      return "";
  }
}

// The probe's part of the operation: how it was touched is what is looked at.
bool is_of_probe(operation::Step step) {
  using operation::Step;
  return step == Step::WorldMarker || step == Step::Digitise || step == Step::Register ||
         step == Step::Verify;
}

bool asks_for_probe(const operation::OperationState& state) {
  using operation::NextAction;
  switch (state.next_action) {
    case NextAction::CheckGuide:
    case NextAction::ConfirmTimeOut:
      return false;
    case NextAction::StartSource:  // other pictures, to go on where these ended
      return state.verification == operation::Verification::NotYet;
    default:
      return is_of_probe(operation::step_of(state.next_action));
  }
}

// Why nothing guides. True: it does not whatever the next pictures show, until somebody does something about
// it.
bool explain(NavigateDisplay& display, const theatre::LiveState& live) {
  const operation::OperationState& state = *live.operation;
  const pipeline::FrameResult& result = state.frame;
  const pipeline::PipelineOptions& options = state.source->pipeline;
  const operation::RegistrationState& registration = *state.registration;
  if (result.is_blank) {
    display.headline = "No picture";
    display.detail = "The picture is plain: is the light on, is the camera connected?";
    return false;
  }
  if (result.is_torn) {
    display.headline = "Picture torn";
    display.detail = "Parts of two moments in one picture: check cable and capture card";
    return false;
  }
  if (result.is_frozen) {
    display.headline = "Picture frozen";
    display.detail = "The source sends the same picture again and again: check cable and camera";
    return false;
  }
  if (result.is_repeating) {
    display.headline = "Picture does not change";
    display.detail = "The same picture several times on end: it may be about to freeze";
    return false;
  }
  if (state.medium.fit == pipeline::MediumFit::Contradicts) {
    display.headline = "Wrong medium";
    display.detail = "The markers look as in " + camera::medium_to_text(state.medium.other_index) +
                     ", not as in " + camera::medium_to_text(state.medium.stated_index);
    return true;
  }
  using operation::Standing;
  const Standing standing = registration.in_force.standing;
  if (standing == Standing::Alarm) {
    tell(display, trouble_of(registration));
    return true;
  }
  if (!result.intrinsics_are_known && !options.tools.tracker) {
    tell(display, trouble_of(result.lens));
    if (display.headline.empty()) display.headline = "Lens angle unknown";
    return false;
  }
  if (standing == Standing::Void || standing == Standing::InDoubt) {
    tell(display, trouble_of(registration));
    return true;
  }
  if (!live.tracker_trouble.empty() && !result.world_is_seen()) {
    tell(display, {"Tracker lost", live.tracker_trouble});
    return false;
  }
  switch (cause_of(state)) {
    case GuidanceState::Valid:
      break;
    case GuidanceState::NoPlan:
      display.headline = "No plan";
      display.detail = "Plan the tunnel of this bone first";
      return true;
    case GuidanceState::WrongMedium:  // told above; a record may say it alone
      display.headline = "Wrong medium";
      break;
    case GuidanceState::NotConfirmed:
      display.headline = "Time-out not confirmed";
      display.detail = "Patient, knee, plan, camera, tools and medium: Space confirms them";
      return true;
    case GuidanceState::GuideNotChecked:
      tell(display, trouble_of(state.guide_check, options.guide_name));
      if (display.headline.empty()) tell(display, {"Guide checked", "It guides from the next picture on"});
      return true;
    case GuidanceState::NoGuide:
      display.headline = "No drill guide";
      display.detail = options.tools.find_tool(options.guide_name) == nullptr
                           ? "The tools of this case hold no " + options.guide_name
                           : "The axis of the " + options.guide_name + " is not known: measure it in Set up";
      return true;
    case GuidanceState::NoRegistration:
      // Nothing can be touched while the marker is lost: that comes first.
      if (!result.world_is_seen()) {
        display.headline = "Bone marker lost";
        if (const auto* marker = options.tools.find_world_marker(options.bone))
          display.detail = reason_of_marker(result, marker->marker_id);
        break;
      }
      display.headline = "Not registered";
      display.detail = !registration.bone_trouble.empty() ? registration.bone_trouble
                       : registration.is_fitting          ? "Registering now"
                                                          : "Draw on the bone with the probe, then register";
      break;
    case GuidanceState::RegistrationUnreliable:
      tell(display, trouble_of(registration));
      // It was found to hold after this picture was worked in.
      if (display.headline.empty())
        tell(display, {"Registration taken", "It guides from the next picture on"});
      break;
    case GuidanceState::WorldMarkerLost:
      display.headline = "Bone marker lost";
      if (const auto* marker = options.tools.find_world_marker(options.bone))
        display.detail = reason_of_marker(result, marker->marker_id);
      break;
    case GuidanceState::GuideLost:
      display.headline = "Drill guide lost";
      if (const auto* tool = options.tools.find_tool(options.guide_name))
        display.detail = reason_of_marker(result, tool->marker_id);
      break;
    case GuidanceState::PictureTorn:
      display.headline = "Picture torn";
      display.detail = "It holds parts of two moments";
      break;
    case GuidanceState::ErrorUnknown:
      display.headline = "Too near the rim";
      display.detail = "How far off the pose is cannot be said there: bone marker and guide into the middle";
      break;
    case GuidanceState::PictureLate:
      tell(display, {"Picture late", live.trouble_words});
      break;
    case GuidanceState::PicturesSlow:
      tell(display, {headline_of(theatre::SourceTrouble::Slow), live.trouble_words});
      break;
    case GuidanceState::MediumUnsure:
      display.headline = "Checking the medium";
      display.detail = "Whether the markers look as in " + camera::medium_to_text(state.medium.stated_index) +
                       ": hold bone marker and guide in view";
      break;
    case GuidanceState::LensStale:
      display.headline = "Lens angle unknown";
      display.detail = trouble_of(result.lens).advice;
      break;
    case GuidanceState::Stale:  // also what was reckoned by what is not in force any more
      display.headline = "Nothing guides yet";
      display.detail = "The next picture that shows bone marker and guide together gives the numbers";
      break;
  }
  return false;
}

}  // namespace

bool breaks_out(const NavigateDisplay& display) {
  using guidance::Breakout;
  return display.drill &&
         (display.drill->breakout == Breakout::Imminent || display.drill->breakout == Breakout::Through);
}

bool gets_screen(const NavigateDisplay& display, const operation::OperationState& state) {
  return display.guidance_is_valid || display.drill || state.guided_lately;
}

bool is_under_way(const theatre::LiveState& live) {
  return live.phase == Phase::Starting || live.phase == Phase::Running;
}

bool awaits_picture(const theatre::LiveState& live) {
  return live.phase == Phase::Starting || (live.phase == Phase::Running && live.picture == nullptr);
}

bool pictures_are_late(const theatre::LiveState& live) {
  constexpr double kNearly = 0.7;  // what is left of the limit is a frame of the screen
  if (live.phase != Phase::Running || live.picture == nullptr) return false;
  return live.operation->source->kind == sources::SourceKind::Live &&
         live.published_s - live.captured_s > kNearly * live.stale_after_s;
}

bool is_of_source_before(const theatre::LiveState& live) {
  return live.phase == Phase::Starting || (live.phase == Phase::Failed && live.picture == nullptr);
}

NavigateLayout layout_of(const theatre::LiveState& live, double since_guidance_s,
                         std::optional<operation::Step> looked_at, double since_touch_s) {
  constexpr double kTouchIsRead_s = 5;
  if (live.phase == Phase::NoSource || since_guidance_s < kGuideAway_s) return NavigateLayout::Guide;
  const operation::OperationState& state = *live.operation;
  const bool stands = state.registration->in_force.standing == operation::Standing::Stands;
  if (!stands) return NavigateLayout::Register;
  if (state.guided_lately) return NavigateLayout::Guide;
  const bool is_of_now = looked_at ? is_of_probe(*looked_at) : asks_for_probe(state);
  if (is_of_now || since_touch_s < kTouchIsRead_s) return NavigateLayout::Register;
  // Once touches have verified it, or it was aimed by, strokes that may go on are not what is looked at.
  const bool is_behind =
      state.drilled.has_evidence || state.verification == operation::Verification::ByTouches;
  return is_behind || !state.draws ? NavigateLayout::Guide : NavigateLayout::Register;
}

bool is_live(const theatre::LiveState* live, double now_s) {
  if (live == nullptr || live->picture == nullptr || live->phase == Phase::NoSource ||
      live->phase == Phase::Failed || live->phase == Phase::Ended)
    return false;
  return theatre::is_of_now(live->age_s(now_s), live->trouble, live->stale_after_s);
}

NavigateDisplay display_of(const theatre::LiveState* live, double now_s) {
  NavigateDisplay display;
  if (live == nullptr || live->phase == Phase::NoSource) {
    display.headline = "No picture";
    display.detail = "Space starts the next step";
    return display;
  }
  if (live->phase == Phase::Failed) {
    display.headline = "Source failed";
    display.detail = live->message;
    return display;
  }
  if (live->picture == nullptr) {
    const bool has_ended = live->phase == Phase::Ended;
    display.headline = has_ended ? "No picture in the source" : "Starting";
    display.detail = has_ended ? "It ended before its first picture" : "Waiting for the first picture";
    return display;
  }
  display.has_picture = true;
  if (live->phase == Phase::Ended) {
    tell(display, trouble_of_end(*live->operation));
    return display;
  }
  display.age_s = live->age_s(now_s);
  // That a slow source has stopped is told by trouble.
  const bool is_slow = live->trouble == theatre::SourceTrouble::Slow;
  if (!is_live(live, now_s)) {
    const bool is_short = display.age_s < 1;
    // What is wrong with the source comes first; what lasts stays said while a busy machine is late with one.
    const bool is_late = live->trouble == theatre::SourceTrouble::Late || is_slow;
    const bool is_late_alone = live->trouble == theatre::SourceTrouble::None || is_late;
    if (is_short && is_late_alone && explain(display, *live)) return display;
    // Pictures that come late all the while are no silence.
    const bool come = is_short || is_late;
    display.headline = is_short ? headline_of(live->trouble) : "";
    if (display.headline.empty())
      display.headline = come ? "Picture " + late_by(display.age_s) + " late"
                              : "No new picture for " + widgets::fixed(std::floor(display.age_s), 0) + " s";
    display.detail = live->trouble_words.empty() ? "What you see is not live" : live->trouble_words;
    return display;
  }
  display.is_live = true;
  const operation::OperationState& state = *live->operation;
  const pipeline::FrameResult& result = state.frame;
  // What is known by now counts, whatever the frame was computed with.
  const operation::Standing standing = state.registration->in_force.standing;
  const bool is_revoked = standing == operation::Standing::Alarm || standing == operation::Standing::Void ||
                          standing == operation::Standing::InDoubt;
  display.overlay_is_valid =
      result.camera_from_world.is_valid && result.intrinsics_are_known && !result.is_frozen && !is_revoked;
  // What was not confirmed may be of another knee: no number, and none of the plan's lines.
  // Nor is there any where the pictures do not come in time, which the operation has judged.
  const bool may_guide = standing == operation::Standing::Stands &&
                         state.time_out != operation::TimeOut::Due &&
                         state.timing == operation::PictureTiming::InTime;
  display.plan_is_valid = display.overlay_is_valid && may_guide;
  display.is_unverified = may_guide && state.verification == operation::Verification::Skipped;
  // An outside tracker's numbers hang on no picture, and nothing of theirs lies over one.
  display.world_is_placed =
      display.overlay_is_valid || (result.tracker_from_world.is_valid && !result.is_frozen && !is_revoked);
  display.tip_is_valid = display.world_is_placed && may_guide && result.tip_is_valid;
  display.guidance_is_valid = display.world_is_placed && may_guide && result.guidance.is_valid();
  if (display.world_is_placed && may_guide && is_of_guide_alone(result.guidance.state))
    display.drill = result.guidance.drill;
  if (display.guidance_is_valid) {
    display.guidance = result.guidance;
    display.grades = state.grades;
  } else if (!explain(display, *live) && state.timing == operation::PictureTiming::Slow &&
             standing == operation::Standing::Stands) {
    tell(display, {headline_of(theatre::SourceTrouble::Slow), live->trouble_words});
  }
  return display;
}

}  // namespace arthronaut::navigate
