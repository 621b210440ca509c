#include <Eigen/Geometry>

#include "app/plan/anatomical_text.h"
#include "app/plan/plan_view.h"
#include "app/widgets/tooltip.h"

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
    case tunnels::PlanCheck::Verdict::NotChecked:
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

void draw_saved(const widgets::Ui& ui, const open_case::PlanStatus& status) {
  button_pair(ui, "plan.undo", "plan.redo");
  widgets::status_row(ui, severity_of(status.save), "Plan", status.text);
}

// What to do next, and the button that begins it.
void draw_next(const widgets::Ui& ui, const NextStep& next) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, edge = ui.theme.px(12);
  ImFont* font = ui.theme.strong;
  const float words = font->CalcTextSizeA(font->FontSize, 1e9F, width - 2 * edge, next.text.c_str()).y;
  const float height = ui.theme.body->FontSize + words + 2 * edge;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(24, 44, 58, 255), ui.theme.px(6));
  draw.AddRectFilled(at, {at.x + ui.theme.px(5), at.y + height}, widgets::kAccent, ui.theme.px(3));
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {at.x + edge, at.y + edge * 0.7F}, widgets::kAccent,
               "Next");
  draw.AddText(font, font->FontSize, {at.x + edge, at.y + edge * 0.7F + ui.theme.body->FontSize},
               widgets::kText, next.text.c_str(), nullptr, width - 2 * edge);
  ImGui::PushID("next");
  if (ImGui::InvisibleButton("do", {width, height})) ui.actions.run(next.action);
  ImGui::PopID();
  ui.log.note("plan.next", at, {at.x + width, at.y + height});
}

void draw_checks(const widgets::Ui& ui, const PlanPanel& panel) {
  const auto tunnel = panel.model.tunnel(panel.bone);
  if (!tunnel) {
    widgets::text_in(ui.theme.body, widgets::kText,
                     "No tunnel yet. Press P and click on the bone where it is to begin.");
    return;
  }
  const tunnels::TunnelGeometry& geometry = panel.model.measured(panel.bone);
  draw_numbers(ui, *tunnel, geometry);
  if (geometry.enters_bone)
    widgets::text_in(
        ui.theme.body, widgets::kText,
        "Leaves the bone " +
            anatomical_text(geometry.exit_mm - geometry.entry_on_surface_mm, panel.model.axes(panel.bone)) +
            " of the entry");
  ImGui::Dummy({0, ui.theme.px(4)});
  for (const tunnels::PlanCheck& check : panel.model.checks(panel.bone)) {
    ImGui::BeginGroup();
    widgets::status_row(ui, severity_of(check.verdict), check.name, check.text);
    ImGui::EndGroup();
    if (ImGui::IsItemHovered() && !check.source.empty()) widgets::tooltip(ui.theme, check.source);
  }
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "Customary values, not limits of safety. The surgeon decides.");
}

// Whose tunnel it is, and beside it the way to the other.
void draw_title(const widgets::Ui& ui, bones::BoneKind bone) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ui.theme.px(196), height = ui.theme.px(44);
  ImGui::GetWindowDrawList()->AddText(ui.theme.title, ui.theme.title->FontSize,
                                      {at.x, at.y + (height - ui.theme.title->FontSize) / 2}, widgets::kText,
                                      bone == bones::BoneKind::Femur ? "Femoral tunnel" : "Tibial tunnel");
  ImGui::SetCursorScreenPos({at.x + ImGui::GetContentRegionAvail().x - width, at.y});
  widgets::action_button(ui, "plan.bone", width, height);
}

void draw_tools(const widgets::Ui& ui) {
  ImGui::Separator();
  button_pair(ui, "plan.default", "plan.place");
  button_pair(ui, "plan.narrower", "plan.wider");
  widgets::action_button(ui, "plan.remove", ImGui::GetContentRegionAvail().x);
}

// Every step, the newest last; a click goes back, or forward, to it.
std::optional<std::size_t> draw_steps(const widgets::Ui& ui, const open_case::PlanHistory& history) {
  std::optional<std::size_t> clicked;
  widgets::text_in(ui.theme.body, widgets::kQuietText, "Click on a step to go back or forward to it.");
  ImGui::BeginChild("steps", {0, ImGui::GetContentRegionAvail().y - ui.theme.px(110)});
  const float height = ui.theme.px(36);
  for (std::size_t i = 0; i <= history.step_count(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::InvisibleButton("step", {width, height})) clicked = i;
    const bool is_here = i == history.position(), is_undone = i > history.position();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (is_here || ImGui::IsItemHovered())
      draw.AddRectFilled(at, {at.x + width, at.y + height},
                         is_here ? IM_COL32(28, 74, 104, 255) : IM_COL32(38, 47, 57, 255), ui.theme.px(6));
    if (is_here) ImGui::SetScrollHereY(1);
    ImGui::PopID();
    const std::string text = i == 0 ? "As it was opened" : history.step_name(i - 1);
    ImFont* font = ui.theme.body;
    draw.AddText(font, font->FontSize, {at.x + ui.theme.px(10), at.y + (height - font->FontSize) / 2},
                 is_undone ? widgets::kPanelEdge
                 : is_here ? widgets::kText
                           : widgets::kQuietText,
                 (text + (is_undone ? "  (undone)" : "")).c_str());
    if (ImGui::IsRectVisible(at, {at.x + width, at.y + height}))
      ui.log.note("plan.step." + std::to_string(i), at, {at.x + width, at.y + height});
  }
  ImGui::EndChild();
  return clicked;
}

}  // namespace

PanelClick draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const PlanPanel& panel) {
  PanelClick clicked;
  widgets::begin_panel(ui, "plan.panel", area);
  draw_next(ui, panel.next);
  draw_title(ui, panel.bone);
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ui.theme.px(6)) / 3;
  for (const char* id : {"plan.checks_page", "plan.landmarks_page", "plan.steps_page"}) {
    widgets::action_button(ui, id, third);
    ImGui::SameLine(0, ui.theme.px(6));
  }
  ImGui::NewLine();
  switch (panel.page) {
    case PanelPage::Checks:
      // The checks scroll; what is pressed stays in sight.
      ImGui::BeginChild("checks", {0, ImGui::GetContentRegionAvail().y - ui.theme.px(262)});
      draw_checks(ui, panel);
      ImGui::EndChild();
      draw_tools(ui);
      ImGui::Separator();
      break;
    case PanelPage::Landmarks:
      clicked.landmark = draw_landmark_list(ui, panel.model, panel.bone, panel.landmark);
      button_pair(ui, "plan.landmark_confirm", "plan.landmark_place");
      widgets::action_button(ui, "plan.landmark_reset", ImGui::GetContentRegionAvail().x);
      break;
    case PanelPage::Steps:
      clicked.step = draw_steps(ui, panel.history);
      break;
  }
  draw_saved(ui, panel.history.status());
  widgets::end_panel();
  return clicked;
}

}  // namespace arthronaut::plan
