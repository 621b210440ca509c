#include <algorithm>
#include <cmath>

#include "app/guidance_severity/guidance_severity.h"
#include "app/navigate/navigate_panels.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

bool is_needed(const NavigateScreen& screen, int marker_id) {
  const pipeline::PipelineOptions& options = *screen.options;
  const auto* probe = options.tools.find_tool(options.probe_name);
  const auto* guide = options.tools.find_tool(options.guide_name);
  const auto* tool = screen.layout == NavigateLayout::Register ? probe : guide;
  return tool != nullptr && tool->marker_id == marker_id;
}

void draw_markers(const widgets::Ui& ui, const NavigateScreen& screen) {
  const pipeline::FrameResult& result = screen.status->live->result;
  const auto* world = screen.options->tools.find_world_marker(screen.options->bone);
  for (const markers::MarkerObservation& marker : result.markers) {
    const bool is_world = world != nullptr && world->marker_id == marker.id;
    // A tool that nobody needs now is worth a line only while it is seen.
    const bool is_seen = marker.state != markers::MarkerState::NotSeen;
    if (!is_world && !is_seen && !is_needed(screen, marker.id)) continue;
    const bool stands = screen.display.is_live && result.stands_for(marker);
    std::string text(markers::to_text(marker.state));
    if (!screen.display.is_live) text = "no live picture";
    if (screen.display.is_live && marker.is_tracked() && !stands) text = "lens angle unknown";
    const Severity severity = stands                                            ? Severity::Good
                              : !screen.display.is_live                         ? Severity::Quiet
                              : is_world                                        ? Severity::Bad
                              : is_needed(screen, marker.id)                    ? Severity::Caution
                              : marker.state == markers::MarkerState::Duplicate ? Severity::Caution
                                                                                : Severity::Quiet;
    widgets::status_row(ui, severity, guidance_severity::marker_name(screen.options->tools, marker.id), text);
  }
}

void draw_lens(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (!screen.display.is_live)
    return widgets::status_row(ui, Severity::Quiet, "Lens mark", "no live picture");
  const pipeline::FrameResult& result = screen.status->live->result;
  const std::string angle = widgets::fixed(result.lens.mark_angle_deg, 0) + "\u00B0";
  const LensTrouble trouble = trouble_of(result.lens);
  if (trouble.headline.empty()) return widgets::status_row(ui, Severity::Good, "Lens mark", angle);
  // The last angle serves for a moment; afterwards the camera is not known and nothing is measured.
  widgets::status_row(ui, result.intrinsics_are_known ? Severity::Caution : Severity::Bad, trouble.headline,
                      result.intrinsics_are_known ? "the last angle still serves: " + angle
                                                  : "camera not known. " + trouble.advice);
}

void draw_registration_row(const widgets::Ui& ui, const NavigateScreen& screen) {
  const OperationStatus& status = *screen.status;
  const std::string points = std::to_string(status.bone->drawn->size()) + " points";
  const bool draws = status.digitises && screen.display.is_live;
  widgets::status_row(ui, draws ? Severity::Good : Severity::Quiet, "Probe draws",
                      draws ? points : "off, " + points);
  if (status.is_registering) return widgets::status_row(ui, Severity::Quiet, "Registration", "running");
  if (!status.bone->bone_trouble.empty())
    return widgets::status_row(ui, Severity::Bad, "Registration", status.bone->bone_trouble);
  if (status.bone->in_force == nullptr)
    return widgets::status_row(ui, Severity::Quiet, "Registration", "none yet");
  const registration::RegistrationSummary& r = *status.bone->in_force;
  if (!r.has_pose || !r.reliable) {
    const std::string why = r.reasons.empty() ? "not reliable" : r.reasons.front();
    return widgets::status_row(ui, Severity::Bad, "Registration", why);
  }
  // In one line on the smallest screen: how well it fits stands in the registration panel.
  widgets::status_row(ui, Severity::Good, "Registration",
                      widgets::plus_minus(r.predicted_tre_mm) + " mm, " +
                          (is_verified(*status.bone) ? "verified" : "not verified") +
                          (status.bone->is_chosen ? ", an earlier one" : ""));
}

// The last touch, where the large number of the registration panel is not shown.
void draw_touch_row(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (screen.layout == NavigateLayout::Register) return;
  if (!screen.status->touch_notice.empty())
    widgets::status_row(ui, Severity::Caution, "No touch taken", screen.status->touch_notice);
  else if (const auto& touch = screen.words.touch)
    widgets::status_row(ui, touch->number.sign, touch->number.name, touch->number.text);
}

// Touch a place that you know: how far the tip is from the bone model, while both are known.
void draw_probe(const widgets::Ui& ui, const NavigateScreen& screen) {
  const OperationStatus& status = *screen.status;
  if (!screen.display.is_live || status.bone->in_force == nullptr || !status.bone->in_force->reliable ||
      screen.surface == nullptr)
    return;
  const pipeline::FrameResult& result = status.live->result;
  if (!result.tip_is_valid) return;
  const double distance = screen.surface->signed_distance_mm(
      status.bone->in_force->marker_from_bone.inverse() * result.tip_in_world_mm);
  widgets::status_row(ui, Severity::Quiet, "Probe tip to bone", widgets::fixed(distance, 1) + " mm");
}

void draw_record(const widgets::Ui& ui, const NavigateScreen& screen) {
  const OperationStatus& status = *screen.status;
  if (!status.recording_error.empty())
    widgets::status_row(ui, Severity::Bad, "Recording stopped", status.recording_error);
  else
    widgets::status_row(ui, status.recording.empty() ? Severity::Quiet : Severity::Good, "Recording",
                        status.recording.empty() ? "off" : status.recording.filename().string());
  if (status.live != nullptr)
    widgets::status_row(ui, Severity::Quiet, "Rate",
                        widgets::fixed(status.frames_per_second, 0) + " pictures/s, " +
                            widgets::fixed(status.live->result.processing_ms, 0) + " ms each");
}

}  // namespace

void draw_tracking(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  widgets::begin_panel(ui, "navigate.tracking", area);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(8), ui.theme.px(7)});
  widgets::text_in(ui.theme.strong, widgets::kAccent, "Next: " + screen.next_step);
  if (screen.status == nullptr) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, screen.display.detail);
  } else {
    if (screen.status->live != nullptr) {
      draw_lens(ui, screen);
      draw_markers(ui, screen);
    }
    draw_registration_row(ui, screen);
    draw_touch_row(ui, screen);
    draw_probe(ui, screen);
    draw_record(ui, screen);
    widgets::status_row(ui, Severity::Quiet, screen.title, screen.calibration);
  }
  ImGui::PopStyleVar();
  widgets::end_panel();
}

}  // namespace arthronaut::navigate
