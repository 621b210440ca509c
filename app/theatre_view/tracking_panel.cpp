#include <algorithm>
#include <cmath>

#include "app/theatre_view/theatre_panels.h"

namespace arthronaut::theatre_view {

namespace {

using widgets::Sign;

bool is_needed(const pipeline::PipelineOptions& options, int marker_id) {
  const auto* world = options.tools.find_world_marker(options.bone);
  const auto* probe = options.tools.find_tool(options.probe_name);
  const auto* guide = options.tools.find_tool(options.guide_name);
  return (world != nullptr && world->marker_id == marker_id) ||
         (probe != nullptr && probe->marker_id == marker_id) ||
         (guide != nullptr && guide->marker_id == marker_id);
}

void draw_markers(const widgets::Ui& ui, const TheatreScreen& screen) {
  const pipeline::FrameResult& result = screen.status->live->result;
  for (const markers::MarkerObservation& marker : result.markers) {
    if (!is_needed(*screen.options, marker.id)) continue;
    const bool stands = screen.display.is_live && result.stands_for(marker);
    const auto* world = screen.options->tools.find_world_marker(screen.options->bone);
    const bool is_world = world != nullptr && world->marker_id == marker.id;
    const bool is_plain_absence = marker.state == markers::MarkerState::NotSeen && !is_world;
    std::string text =
        !screen.display.is_live ? "no live picture" : std::string(markers::to_text(marker.state));
    if (screen.display.is_live && marker.is_tracked() && !stands) text = "lens angle unknown";
    widgets::status_row(ui,
                        stands             ? Sign::Good
                        : is_plain_absence ? Sign::Quiet
                        : is_world         ? Sign::Bad
                                           : Sign::Caution,
                        marker_name(screen.options->tools, marker.id), text);
  }
  const lens::LensObservation& lens = result.lens;
  const std::string angle = widgets::fixed(lens.mark_angle_deg, 0) + "\u00B0";
  if (!screen.display.is_live)
    widgets::status_row(ui, Sign::Quiet, "Lens mark", "no live picture");
  else if (lens.mark == lens::MarkState::Found)
    widgets::status_row(ui, lens.zoom_or_slip ? Sign::Caution : Sign::Good, "Lens mark",
                        lens.zoom_or_slip ? "another zoom, or the coupler slipped" : angle);
  else
    widgets::status_row(
        ui, result.intrinsics_are_known ? Sign::Caution : Sign::Bad, "Lens mark",
        std::string(lens::to_text(lens.mark)) + (result.intrinsics_are_known ? ", last " + angle : ""));
}

// How far the registration is, and the one thing to do next.
void draw_coach(const widgets::Ui& ui, const registration::Coach& coach) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float left = at.x + ui.theme.px(30),
              width = std::max(ImGui::GetContentRegionAvail().x - ui.theme.px(30), 1.F);
  const float height = ui.theme.px(12);
  draw.AddRectFilled({left, at.y}, {left + width, at.y + height}, IM_COL32(14, 17, 21, 255), height / 2);
  const float done = width * static_cast<float>(std::clamp(coach.progress, 0.0, 1.0));
  if (done > height)
    draw.AddRectFilled({left, at.y}, {left + done, at.y + height}, widgets::kAccent, height / 2);
  ImGui::Dummy({width, height});
  ImGui::Indent(ui.theme.px(30));
  widgets::text_in(ui.theme.body, widgets::kText, coach.message);
  ImGui::Unindent(ui.theme.px(30));
}

void draw_registration(const widgets::Ui& ui, const TheatreScreen& screen) {
  const OperationStatus& status = *screen.status;
  const std::string points = std::to_string(status.trail->size()) + " points";
  widgets::status_row(ui, status.digitises ? Sign::Good : Sign::Quiet, "Probe draws",
                      status.digitises ? points : "off, " + points);
  if (status.online != nullptr && status.digitises) draw_coach(ui, status.online->coach);
  if (status.is_registering) return widgets::status_row(ui, Sign::Quiet, "Registration", "running");
  if (!status.registration) return widgets::status_row(ui, Sign::Quiet, "Registration", "none yet");
  const registration::RegistrationSummary& r = *status.registration;
  if (!r.has_pose || !r.reliable) {
    const std::string why = r.reasons.empty() ? "not reliable" : r.reasons.front();
    return widgets::status_row(ui, Sign::Bad, "Registration", why);
  }
  widgets::status_row(ui, Sign::Good, "Registration",
                      "target " + widgets::plus_minus(r.predicted_tre_mm) + " mm, fit " +
                          widgets::fixed(r.rms_mm, 1) + " mm");
}

// Touch a place that you know: how far the tip is from the bone model, while both are known.
void draw_probe(const widgets::Ui& ui, const TheatreScreen& screen) {
  const OperationStatus& status = *screen.status;
  if (!screen.display.is_live || !status.registration || !status.registration->reliable ||
      screen.surface == nullptr)
    return;
  const pipeline::FrameResult& result = status.live->result;
  if (!result.tip_is_valid) return;
  const double distance = screen.surface->signed_distance_mm(status.registration->marker_from_bone.inverse() *
                                                             result.tip_in_world_mm);
  widgets::status_row(ui, Sign::Quiet, "Probe tip to bone", widgets::fixed(distance, 1) + " mm");
}

void draw_record(const widgets::Ui& ui, const TheatreScreen& screen) {
  const OperationStatus& status = *screen.status;
  if (!status.recording_error.empty())
    widgets::status_row(ui, Sign::Bad, "Recording stopped", status.recording_error);
  else
    widgets::status_row(ui, status.recording.empty() ? Sign::Quiet : Sign::Good, "Recording",
                        status.recording.empty() ? "off" : status.recording.filename().string());
  if (status.live != nullptr)
    widgets::status_row(ui, Sign::Quiet, "Rate",
                        widgets::fixed(status.frames_per_second, 0) + " pictures/s, " +
                            widgets::fixed(status.live->result.processing_ms, 0) + " ms each");
}

}  // namespace

void draw_tracking(const widgets::Ui& ui, const widgets::Rect& area, const TheatreScreen& screen) {
  widgets::begin_panel(ui, "operate.tracking", area);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(8), ui.theme.px(7)});
  widgets::text_in(ui.theme.strong, widgets::kAccent, "Next: " + screen.next_step);
  if (screen.status == nullptr) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, screen.display.detail);
  } else {
    if (screen.status->live != nullptr) draw_markers(ui, screen);
    draw_registration(ui, screen);
    draw_probe(ui, screen);
    draw_record(ui, screen);
  }
  ImGui::PopStyleVar();
  widgets::end_panel();
}

}  // namespace arthronaut::theatre_view
