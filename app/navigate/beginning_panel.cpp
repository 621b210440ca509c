#include "app/navigate/beginning_panel.h"

#include <imgui_stdlib.h>

#include <algorithm>

namespace arthronaut::navigate {

namespace {

// The names in small letters, what they say in letters for afar, under each other.
struct CardPlan {
  ImFont *text, *name;
  float height = 0;
};

CardPlan plan_of(const widgets::Ui& ui, float width, const Card& card, ImFont* text) {
  CardPlan plan{text, ui.theme.title};
  const auto add = [&](ImFont* font, const std::string& words) {
    if (!words.empty()) plan.height += font->CalcTextSizeA(font->FontSize, 1e9F, width, words.c_str()).y;
  };
  add(text, card.title);
  for (const CardLine& line : card.lines) {
    plan.height += plan.name->FontSize + ui.theme.px(8);
    add(text, line.text);
  }
  add(text, card.keys);
  plan.height += ui.theme.px(24);
  return plan;
}

}  // namespace

void draw_card(const widgets::Ui& ui, const widgets::Rect& area, const Card& card) {
  ui.log.note(card.name, area.min(), area.max());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), widgets::kAccent, ui.theme.px(6), 0, ui.theme.px(3));
  draw.PushClipRect(area.min(), area.max(), true);
  widgets::Rect box = area.inset(ui.theme.px(16));
  // In smaller letters where there is too much of it: nothing of what is confirmed may be cut off.
  CardPlan plan = plan_of(ui, box.width, card, ui.theme.afar);
  if (plan.height > box.height) plan = plan_of(ui, box.width, card, ui.theme.title);
  if (plan.height > box.height) plan = plan_of(ui, box.width, card, ui.theme.strong);
  ui.log.note_state("card_letters", plan.text == ui.theme.afar ? "afar" : "smaller");
  const auto put = [&](ImFont* font, ImU32 color, const std::string& words, float indent) {
    if (words.empty()) return;
    draw.AddText(font, font->FontSize, {box.x + indent, box.y}, color, words.c_str(), nullptr, box.width);
    (void)box.cut_top(font->CalcTextSizeA(font->FontSize, 1e9F, box.width, words.c_str()).y);
  };
  put(plan.text, widgets::kText, card.title, 0);
  for (const CardLine& line : card.lines) {
    (void)box.cut_top(ui.theme.px(8));
    const bool is_quiet = line.severity == widgets::Severity::Quiet;
    const float radius = plan.name->FontSize * 0.4F;
    if (!is_quiet)
      widgets::draw_sign(draw, {box.x + radius, box.y + plan.name->FontSize / 2}, radius, line.severity);
    put(plan.name, widgets::kQuietText, line.name, is_quiet ? 0 : 3 * radius);
    put(plan.text, is_quiet ? widgets::kText : widgets::color_of(line.severity), line.text, 0);
  }
  (void)box.cut_top(ui.theme.px(10));
  put(plan.text, widgets::kAccent, card.keys, 0);
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
  if (!wants_focus_ && ImGui::IsItemDeactivated()) close();
  wants_focus_ = false;
  return std::nullopt;
}

}  // namespace arthronaut::navigate
