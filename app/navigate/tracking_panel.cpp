#include <algorithm>
#include <cmath>

#include "app/guidance_severity/guidance_severity.h"
#include "app/navigate/navigate_panels.h"
#include "app/navigate/tracking_words.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

bool is_needed(const NavigateScreen& screen, int marker_id) {
  const pipeline::PipelineOptions& options = screen.options();
  const auto* probe = options.tools.find_tool(options.probe_name);
  const auto* guide = options.tools.find_tool(options.guide_name);
  const auto* tool = screen.is_of_probe() ? probe : guide;
  return tool != nullptr && tool->marker_id == marker_id;
}

// Of a body of several markers also how many of them it is seen by, and which lies where it should not.
std::string text_of(const markers::BodyObservation& body, std::size_t marker_count) {
  std::string text(markers::to_text(body.state));
  if (body.is_tracked() && marker_count > 1)
    text += ", " + std::to_string(body.used_count()) + " of " + std::to_string(marker_count) + " markers";
  if (body.odd_marker != markers::BodyObservation::kNone)
    text += "; marker " + std::to_string(body.odd_marker) + " is out of place";
  return text;
}

// Bodies as an outside tracker sees them, and the tracker itself.
void draw_outside(const widgets::Ui& ui, const NavigateScreen& screen, const tools::OutsideTracker& tracker) {
  const std::string& trouble = screen.live->tracker_trouble;
  widgets::status_row(ui, trouble.empty() ? Severity::Good : Severity::Bad, "Tracker",
                      trouble.empty() ? tracker.address : trouble);
  const tracker::TrackerPoses& outside = screen.frame().outside;
  const auto* world = screen.options().tools.find_world_marker(screen.options().bone);
  for (const tracker::BodyPose& body : outside.bodies) {
    const bool is_world = world != nullptr && world->marker_id == body.id;
    if (!is_world && !body.is_tracked() && !is_needed(screen, body.id)) continue;
    std::string text(tracker::to_text(body.state));
    if (body.is_tracked())
      text += ", " + widgets::fixed(1000 * body.age_s, 0) +
              (outside.times_are_arrivals ? " ms since it came: it bears no time" : " ms old");
    if (!screen.display.is_live) text = "no live picture";
    widgets::status_row(ui,
                        !screen.display.is_live ? Severity::Quiet
                        : body.is_tracked()     ? Severity::Good
                        : is_world              ? Severity::Bad
                                                : Severity::Caution,
                        guidance_severity::marker_name(screen.options().tools, body.id), text);
  }
}

void draw_markers(const widgets::Ui& ui, const NavigateScreen& screen) {
  const pipeline::FrameResult& result = screen.frame();
  if (const auto& tracker = screen.options().tools.tracker) return draw_outside(ui, screen, *tracker);
  const tools::ToolSet& tools = screen.options().tools;
  const auto* world = tools.find_world_marker(screen.options().bone);
  const auto marker_count = [&](int id) {
    for (const tools::WorldMarker& one : tools.world_markers)
      if (one.marker_id == id) return one.markers.size();
    for (const tools::Tool& one : tools.tools)
      if (one.marker_id == id) return one.markers.size();
    return std::size_t{0};
  };
  std::vector<markers::BodyObservation> bodies = result.bodies;
  if (bodies.empty()) {  // made from a record, marker by marker
    for (const markers::MarkerObservation& marker : result.markers) {
      bodies.emplace_back();
      bodies.back().id = marker.id;
      bodies.back().state = marker.state;
    }
  }
  for (const markers::BodyObservation& body : bodies) {
    const bool is_world = world != nullptr && world->marker_id == body.id;
    // A tool that nobody needs now is worth a line only while it is seen.
    const bool is_seen = body.state != markers::MarkerState::NotSeen;
    if (!is_world && !is_seen && !is_needed(screen, body.id)) continue;
    const bool stands = screen.display.is_live && result.intrinsics_are_known && body.is_tracked();
    std::string text = text_of(body, marker_count(body.id));
    if (!screen.display.is_live) text = "no live picture";
    if (screen.display.is_live && body.is_tracked() && !stands) text = "lens angle unknown";
    const bool is_odd = body.odd_marker != markers::BodyObservation::kNone ||
                        body.state == markers::MarkerState::Disagreeing ||
                        body.state == markers::MarkerState::Duplicate;
    const Severity severity = stands && !is_odd            ? Severity::Good
                              : !screen.display.is_live    ? Severity::Quiet
                              : stands                     ? Severity::Caution
                              : is_world                   ? Severity::Bad
                              : is_needed(screen, body.id) ? Severity::Caution
                              : is_odd                     ? Severity::Caution
                                                           : Severity::Quiet;
    widgets::status_row(ui, severity, guidance_severity::marker_name(tools, body.id), text);
  }
}

void draw_lens(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (!screen.display.is_live)
    return widgets::status_row(ui, Severity::Quiet, "Lens mark", "no live picture");
  const pipeline::FrameResult& result = screen.frame();
  const std::string angle = widgets::fixed(result.lens.mark_angle_deg, 0) + "\u00B0";
  const Trouble trouble = trouble_of(result.lens);
  if (trouble.headline.empty()) return widgets::status_row(ui, Severity::Good, "Lens mark", angle);
  // The last angle serves for a moment; afterwards the camera is not known and nothing is measured.
  widgets::status_row(ui, result.intrinsics_are_known ? Severity::Caution : Severity::Bad, trouble.headline,
                      result.intrinsics_are_known ? "the last angle still serves: " + angle
                                                  : "camera not known. " + trouble.advice);
}

void draw_registration_row(const widgets::Ui& ui, const NavigateScreen& screen) {
  const operation::OperationState& state = *screen.live->operation;
  const operation::RegistrationState& known = *state.registration;
  const std::string points = std::to_string(known.point_count) + " points";
  const bool draws = state.draws && screen.display.is_live;
  widgets::status_row(ui, draws ? Severity::Good : Severity::Quiet, "Probe draws",
                      draws ? points : "off, " + points);
  if (known.is_fitting) return widgets::status_row(ui, Severity::Quiet, "Registration", "running");
  if (!known.bone_trouble.empty())
    return widgets::status_row(ui, Severity::Bad, "Registration", known.bone_trouble);
  if (known.in_force.standing == operation::Standing::None) {
    const std::string aside = std::to_string(known.set_aside_count) + " points of another source set aside";
    return widgets::status_row(ui, Severity::Quiet, "Registration",
                               known.set_aside_count > 0 ? aside : "none yet");
  }
  const Trouble trouble = trouble_of(known);
  if (!trouble.empty())
    return widgets::status_row(
        ui, Severity::Bad, trouble.headline,
        known.in_force.registration->reasons.empty() ? "" : known.in_force.registration->reasons.front());
  if (waits_for_time_out(state))
    return widgets::status_row(ui, Severity::Caution, "Registration", "waits for the time-out");
  const bool is_skipped = state.verification == operation::Verification::Skipped;
  // In one line on the smallest screen: how well it fits stands in the registration panel.
  widgets::status_row(ui,
                      is_skipped               ? Severity::Caution
                      : screen.display.is_live ? Severity::Good
                                               : Severity::Quiet,
                      "Registration",
                      widgets::plus_minus(known.in_force.registration->predicted_tre_mm) + " mm, " +
                          (state.verification == operation::Verification::ByTouches ? "verified"
                           : is_skipped                                             ? "verification skipped"
                                                                                    : "not verified") +
                          (known.is_chosen ? ", an earlier one" : ""));
}

// What came of holding a nominal guide against the control point; while it hides guidance that is said in
// large.
void draw_guide_check(const widgets::Ui& ui, const operation::GuideCheckState& guide) {
  if (guide.standing == operation::GuideStanding::Checked)
    widgets::status_row(ui, Severity::Good, "Nominal guide",
                        widgets::fixed(guide.error_mm, 1) + " mm off where it was checked");
  if (guide.standing == operation::GuideStanding::Trusted)
    widgets::status_row(ui, Severity::Caution, "Nominal guide", "nobody checked it");
}

// The last touch, where the large number of the registration panel is not shown.
void draw_touch_row(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (screen.layout == NavigateLayout::Register) return;
  if (const auto& touch = screen.words.touch)
    widgets::status_row(ui, touch->number.severity, touch->number.name, touch->number.text);
}

// Touch a place that you know: how far the tip is from the bone model, while both are known.
void draw_probe(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (!screen.display.tip_is_valid || screen.surface == nullptr) return;
  const operation::RegistrationInForce& in_force = screen.live->operation->registration->in_force;
  const double distance = screen.surface->signed_distance_mm(
      in_force.registration->marker_from_bone.inverse() * screen.frame().tip_in_world_mm);
  widgets::status_row(ui, Severity::Quiet, "Probe tip to bone", widgets::fixed(distance, 1) + " mm");
}

void draw_rows(const widgets::Ui& ui, const std::vector<SeverityText>& rows) {
  for (const SeverityText& row : rows) widgets::status_row(ui, row.severity, row.name, row.text);
}

}  // namespace

void draw_tracking(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  widgets::begin_panel(ui, "navigate.tracking", area);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(8), ui.theme.px(7)});
  widgets::text_in(ui.theme.strong, widgets::kAccent, "Next: " + screen.next_step);
  if (!screen.has_source()) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, screen.display.detail);
  } else {
    if (screen.live->picture != nullptr) {
      draw_lens(ui, screen);
      draw_markers(ui, screen);
    }
    draw_registration_row(ui, screen);
    draw_rows(ui, contour_rows(*screen.live->operation));
    if (screen.is_muted || !screen.sound_trouble.empty())
      widgets::status_row(ui, widgets::Severity::Caution, "Sound",
                          screen.is_muted ? "muted (Y)" : screen.sound_trouble);
    if (!screen.sharing.empty()) widgets::status_row(ui, Severity::Quiet, "OpenIGTLink", screen.sharing);
    draw_guide_check(ui, screen.live->operation->guide_check);
    draw_touch_row(ui, screen);
    draw_probe(ui, screen);
    const operation::OperationState& state = *screen.live->operation;
    draw_rows(ui, beginning_rows(state, screen.patient,
                                 screen.verdict != nullptr ? *screen.verdict : plan_review::TunnelVerdict{}));
    draw_rows(ui, source_rows(*screen.live));
    draw_rows(ui, record_rows(*screen.live, screen.display));
    widgets::status_row(ui, Severity::Quiet, state.source->title, state.source->calibration);
  }
  ImGui::PopStyleVar();
  widgets::end_panel();
}

}  // namespace arthronaut::navigate
