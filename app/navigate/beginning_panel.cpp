#include "app/navigate/beginning_panel.h"

#include <imgui_stdlib.h>

#include <algorithm>

namespace arthronaut::navigate {

void draw_card(const widgets::Ui& ui, const widgets::Rect& area, const Card& card) {
  const float edge = ui.theme.px(24), row = ui.theme.strong->FontSize + ui.theme.px(14);
  const float width = std::max(area.width - 2 * edge, 1.F);
  const float value_x = width * 0.3F;
  // Text may need more than a line.
  const auto height_of = [&](const CardLine& line) {
    const ImVec2 size =
        ui.theme.strong->CalcTextSizeA(ui.theme.strong->FontSize, 1e9F, width - value_x, line.text.c_str());
    return std::max(size.y + ui.theme.px(14), row);
  };
  float height = 2 * edge + 2 * row + ui.theme.title->FontSize;
  for (const CardLine& line : card.lines) height += height_of(line);
  widgets::Rect box{area.x, std::max(area.center().y - height / 2, area.y), area.width,
                    std::min(height, area.height)};
  ui.log.note(card.name, box.min(), box.max());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(box.min(), box.max(), IM_COL32(10, 12, 15, 255));
  draw.PushClipRect(box.min(), box.max(), true);
  box = box.inset(edge);
  widgets::text_centered(ui, box.cut_top(ui.theme.title->FontSize + row / 2), ui.theme.title, widgets::kText,
                         card.title);
  for (const CardLine& line : card.lines) {
    const widgets::Rect place = box.cut_top(height_of(line));
    const float radius = ui.theme.px(10);
    const float middle = place.y + ui.theme.strong->FontSize / 2;
    const bool is_quiet = line.severity == widgets::Severity::Quiet;
    if (!is_quiet) widgets::draw_sign(draw, {place.x + radius, middle}, radius, line.severity);
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {place.x + 3 * radius, place.y},
                 widgets::kQuietText, line.name.c_str());
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {place.x + value_x, place.y},
                 is_quiet ? widgets::kText : widgets::color_of(line.severity), line.text.c_str(), nullptr,
                 width - value_x);
  }
  widgets::text_centered(ui, box.cut_bottom(row), ui.theme.strong, widgets::kAccent, card.keys);
  draw.PopClipRect();
}

void DepthEntry::open() {
  text_.clear();
  trouble_.clear();
  is_open_ = wants_focus_ = true;
}

std::optional<double> DepthEntry::draw(const widgets::Ui& ui, const widgets::Rect& video) {
  if (!is_open_) return std::nullopt;
  widgets::Rect rest = video;
  widgets::Rect bar = rest.cut_bottom(ui.theme.px(120));
  ImGui::GetWindowDrawList()->AddRectFilled(bar.min(), bar.max(), IM_COL32(10, 12, 15, 255));
  bar = bar.inset(ui.theme.px(14));
  widgets::text_centered(
      ui, bar.cut_top(ui.theme.px(42)), ui.theme.strong,
      trouble_.empty() ? widgets::kText : widgets::kCaution,
      trouble_.empty() ? "What the drill's depth stop reads, in mm; then Enter" : trouble_);
  ImGui::SetCursorScreenPos(bar.min());
  ImGui::SetNextItemWidth(bar.width);
  if (wants_focus_) ImGui::SetKeyboardFocusHere();
  const bool is_entered = ImGui::InputText(
      "##depth_stop", &text_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CharsDecimal);
  ui.log.note("navigate.depth_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (is_entered) {
    const std::optional<double> depth_mm = depth_from_text(text_);
    is_open_ = wants_focus_ = !depth_mm;
    text_.clear();  // what is typed next is not added to what was refused
    trouble_ = depth_mm ? "" : "Not a number of millimetres from 0 to 150: once more, then Enter";
    return depth_mm;
  }
  if (!wants_focus_ && ImGui::IsItemDeactivated()) is_open_ = false;
  wants_focus_ = false;
  return std::nullopt;
}

}  // namespace arthronaut::navigate
