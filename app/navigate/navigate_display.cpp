#include "app/navigate/navigate_display.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::navigate {

namespace {

using guidance::GuidanceState;
using Phase = OperationStatus::Phase;

std::string reason_of_marker(const pipeline::FrameResult& result, int marker_id) {
  for (const markers::MarkerObservation& marker : result.markers)
    if (marker.id == marker_id && !marker.is_tracked()) return std::string(markers::to_text(marker.state));
  return "";
}

void explain(NavigateDisplay& display, const OperationStatus& status,
             const pipeline::PipelineOptions& options) {
  const pipeline::FrameResult& result = status.live->result;
  if (result.is_frozen) {
    display.headline = "Picture frozen";
    display.detail = "The source sends the same picture again and again: check cable and camera";
    return;
  }
  if (!status.bone->alarm.empty()) {
    display.headline = "World marker may have moved";
    display.detail = status.bone->alarm +
                     ". Touch the control point again; if it stays off, clear the points (C) and draw anew";
    return;
  }
  if (!result.intrinsics_are_known) {
    const LensTrouble trouble = trouble_of(result.lens);
    display.headline = trouble.headline.empty() ? "Lens angle unknown" : trouble.headline;
    display.detail = trouble.advice;
    return;
  }
  switch (result.guidance.state) {
    case GuidanceState::Valid:
      break;
    case GuidanceState::NoPlan:
      display.headline = "No plan";
      display.detail = "Plan the tunnel of this bone first";
      break;
    case GuidanceState::NoGuide:
      display.headline = "No drill guide";
      display.detail = options.tools.find_tool(options.guide_name) == nullptr
                           ? "The tools of this case hold no " + options.guide_name
                           : "The axis of the " + options.guide_name + " is not known: measure it in Set up";
      break;
    case GuidanceState::NoRegistration:
      // Nothing can be touched while the marker is lost: that comes first.
      if (!result.camera_from_world.is_valid) {
        display.headline = "Bone marker lost";
        if (const auto* marker = options.tools.find_world_marker(options.bone))
          display.detail = reason_of_marker(result, marker->marker_id);
        break;
      }
      display.headline = "Not registered";
      display.detail = !status.bone->bone_trouble.empty() ? status.bone->bone_trouble
                       : status.is_registering            ? "Registering now"
                                                          : "Touch the bone with the probe, then register";
      break;
    case GuidanceState::RegistrationUnreliable:
      display.headline = "Registration not reliable";
      if (status.bone->in_force != nullptr && !status.bone->in_force->reasons.empty())
        display.detail = status.bone->in_force->reasons.front();
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
    case GuidanceState::LensStale:
      display.headline = "Lens angle unknown";
      display.detail = trouble_of(result.lens).advice;
      break;
    case GuidanceState::Stale:
      display.headline = "Poses too old";
      display.detail = "The markers were not seen together";
      break;
  }
}

}  // namespace

NavigateLayout layout_of(const OperationStatus* status, double since_guidance_s) {
  constexpr double kHold_s = 2;
  if (status == nullptr || since_guidance_s < kHold_s) return NavigateLayout::Guide;
  const bool is_registered = status->bone->in_force != nullptr && status->bone->in_force->reliable;
  return is_registered && !status->digitises ? NavigateLayout::Guide : NavigateLayout::Register;
}

LensTrouble trouble_of(const lens::LensObservation& lens) {
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

NavigateDisplay display_of(const OperationStatus* status, const pipeline::PipelineOptions* options,
                           double now_s) {
  NavigateDisplay display;
  if (status == nullptr || options == nullptr) {
    display.headline = "No picture";
    display.detail = "Space starts the next step";
    return display;
  }
  if (status->phase == Phase::Failed) {
    display.headline = "Source failed";
    display.detail = status->message;
    return display;
  }
  if (status->live == nullptr) {
    display.headline = status->phase == Phase::Ended ? "No picture in the source" : "Starting";
    display.detail = "Waiting for the first picture";
    return display;
  }
  display.has_picture = true;
  if (status->phase == Phase::Ended) {
    display.headline = "The source has ended";
    display.detail = "This is its last picture";
    return display;
  }
  const double age_s = now_s - status->live->published_s;
  if (age_s > status->live->stale_after_s) {
    display.headline = "No new picture for " + widgets::fixed(age_s, 1) + " s";
    display.detail = "What you see is not live";
    return display;
  }
  display.is_live = true;
  const pipeline::FrameResult& result = status->live->result;
  display.overlay_is_valid =
      result.camera_from_world.is_valid && result.intrinsics_are_known && !result.is_frozen;
  // An alarm counts from this moment on, whatever the frame was computed with.
  display.overlay_is_valid = display.overlay_is_valid && status->bone->alarm.empty();
  display.guidance_is_valid = display.overlay_is_valid && result.guidance.is_valid();
  if (display.guidance_is_valid)
    display.guidance = result.guidance;
  else
    explain(display, *status, *options);
  return display;
}

BullseyePoint bullseye_point(const guidance::GuidanceNumbers& guidance, const tunnels::Tunnel& plan) {
  const Eigen::Vector3d ahead = plan.direction.normalized();
  const landmarks::PlaneAxes& axes = guidance.across_plan;
  BullseyePoint point;
  point.up_is = axes.up_is;
  point.side_is = axes.side_is;
  // Looking along the plan, with `up` up.
  point.side_is_right = ahead.cross(axes.up).dot(axes.side) > 0;
  const double to_the_right = point.side_is_right ? 1 : -1;
  point.right_mm = to_the_right * guidance.offset_in_mm(axes.side_is);
  point.up_mm = guidance.offset_in_mm(axes.up_is);
  const double advance = guidance.guide_direction.dot(ahead);
  const auto lean = [&](const Eigen::Vector3d& towards) {
    return geometry::deg_from_rad(std::atan2(guidance.guide_direction.dot(towards), advance));
  };
  point.lean_right_deg = to_the_right * lean(axes.side);
  point.lean_up_deg = lean(axes.up);
  return point;
}

}  // namespace arthronaut::navigate
