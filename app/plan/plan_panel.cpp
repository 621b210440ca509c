#include <Eigen/Geometry>

#include "app/plan/anatomical_text.h"
#include "app/plan/plan_view.h"

namespace arthronaut::plan {

namespace {

widgets::Severity severity_of(tunnels::PlanCheck::Verdict verdict) {
  switch (verdict) {
    case tunnels::PlanCheck::Verdict::Fine:
      return widgets::Severity::Good;
    case tunnels::PlanCheck::Verdict::Look:
      return widgets::Severity::Caution;
    case tunnels::PlanCheck::Verdict::Wrong:
      return widgets::Severity::Bad;
    case tunnels::PlanCheck::Verdict::Note:
      return widgets::Severity::Quiet;
  }
  return widgets::Severity::Quiet;
}

widgets::Severity severity_of(open_case::PlanStatus::Save save) {
  switch (save) {
    case open_case::PlanStatus::Save::Saved:
      return widgets::Severity::Good;
    case open_case::PlanStatus::Save::NotYet:
      return widgets::Severity::Quiet;
    case open_case::PlanStatus::Save::Failed:
      return widgets::Severity::Bad;
    case open_case::PlanStatus::Save::ReadOnly:
    case open_case::PlanStatus::Save::Conflict:
      return widgets::Severity::Caution;
  }
  return widgets::Severity::Quiet;
}

void draw_numbers(const widgets::Ui& ui, const tunnels::Tunnel& tunnel,
                  const tunnels::TunnelGeometry& geometry) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(100);
  widgets::Rect row{at.x, at.y, width, height};
  const widgets::Rect left = row.cut_left(width / 2);
  const bool inside = geometry.enters_bone;
  widgets::number_block(ui, left, "Length in bone", inside ? widgets::fixed(geometry.length_mm, 1) : "\u2013",
                        "mm", widgets::Severity::Quiet);
  widgets::number_block(ui, row, "Diameter", widgets::fixed(tunnel.diameter_mm, 1), "mm",
                        widgets::Severity::Quiet);
  ImGui::Dummy({width, height});
}

void button_pair(const widgets::Ui& ui, const char* left, const char* right) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - gap) / 2;
  widgets::action_button(ui, left, width);
  ImGui::SameLine();
  widgets::action_button(ui, right, width);
}

void draw_history(const widgets::Ui& ui, const open_case::PlanStatus& status) {
  button_pair(ui, "plan.undo", "plan.redo");
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   status.undo_what.empty() ? "Nothing to undo" : "Last: " + status.undo_what);
  widgets::status_row(ui, severity_of(status.save), "Plan", status.text);
}

}  // namespace

void draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model,
                     bones::BoneKind bone, const open_case::PlanStatus& status) {
  widgets::begin_panel(ui, "plan.panel", area);
  widgets::text_in(ui.theme.title, widgets::kText,
                   bone == bones::BoneKind::Femur ? "Femoral tunnel" : "Tibial tunnel");
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   std::string(bones::to_text(model.knee().side)) + " knee \u2013 " + model.knee().name);
  ImGui::Separator();
  const auto tunnel = model.tunnel(bone);
  if (tunnel) {
    const tunnels::TunnelGeometry& geometry = model.measured(bone);
    draw_numbers(ui, *tunnel, geometry);
    if (geometry.enters_bone)
      widgets::text_in(
          ui.theme.body, widgets::kText,
          "Leaves the bone " +
              anatomical_text(geometry.exit_mm - geometry.entry_on_surface_mm, model.axes(bone)) +
              " of the entry");
    ImGui::Dummy({0, ui.theme.px(4)});
    for (const tunnels::PlanCheck& check : model.checks(bone)) {
      ImGui::BeginGroup();
      widgets::status_row(ui, severity_of(check.verdict), check.name, check.text);
      ImGui::EndGroup();
      if (ImGui::IsItemHovered() && !check.source.empty()) ImGui::SetTooltip("%s", check.source.c_str());
    }
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Customary values, not limits of safety. The surgeon decides.");
  } else {
    widgets::text_in(ui.theme.body, widgets::kText,
                     "No tunnel yet. Press P and click on the bone where it is to begin.");
  }
  ImGui::Separator();
  button_pair(ui, "plan.place", "plan.bone");
  button_pair(ui, "plan.narrower", "plan.wider");
  widgets::action_button(ui, "plan.remove", ImGui::GetContentRegionAvail().x);
  widgets::text_in(
      ui.theme.body, widgets::kQuietText,
      "Arrow keys aim by 1\u00B0, with Shift they slide the entry by 0.5 mm. Handles can be dragged.");
  ImGui::Separator();
  draw_history(ui, status);
  widgets::end_panel();
}

}  // namespace arthronaut::plan
