#include "app/widgets/list_rows.h"

#include <algorithm>
#include <utility>

#include "app/widgets/wrapped_text.h"

namespace arthronaut::widgets {

void draw_text(ImDrawList& draw, ImFont* font, float x, float y, ImU32 color, const std::string& words,
               float wrap) {
  draw.AddText(font, font->FontSize, {x, y}, color,
               wrap > 0 ? wrapped(font, words, wrap).c_str() : words.c_str(), nullptr, wrap);
}

std::string fitting(ImFont* font, const std::string& words, float width) {
  const auto wide = [&](const std::string& t) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, t.c_str()).x;
  };
  if (wide(words) <= width) return words;
  std::string cut = words;
  while (!cut.empty() && wide(cut + "\u2026") > width) {
    do cut.pop_back();
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U);
    if (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0xC0U) cut.pop_back();
  }
  return cut + "\u2026";
}

std::string fitting_end(ImFont* font, const std::string& words, float width) {
  const auto wide = [&](const std::string& t) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, t.c_str()).x;
  };
  if (wide(words) <= width) return words;
  std::string cut = words;
  while (!cut.empty() && wide("\u2026" + cut) > width) {
    do cut.erase(0, 1);
    while (!cut.empty() && (static_cast<unsigned char>(cut.front()) & 0xC0U) == 0x80U);
  }
  return "\u2026" + cut;
}

void bring_into_sight(std::size_t row, float top_px, float height_px) {
  int& shown = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("row in sight"), -1);
  if (std::exchange(shown, static_cast<int>(row)) == static_cast<int>(row)) return;
  const float list_px = ImGui::GetWindowPos().y;
  if (top_px < list_px || top_px + height_px > list_px + ImGui::GetWindowHeight())
    ImGui::SetScrollHereY(0.5F);
}

void draw_buttons(const Ui& ui, const Rect& bar, std::initializer_list<const char*> ids) {
  ImGui::SetCursorScreenPos(bar.min());
  for (const char* id : ids) {
    action_button(ui, id, 0, bar.height);
    ImGui::SameLine();
  }
}

RowPress draw_row(const Ui& ui, const ListRow& row) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PushID(static_cast<int>(row.number));
  const bool once = ImGui::InvisibleButton("row", {width, row.height});
  const bool hovered = ImGui::IsItemHovered();
  const bool twice = hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
  if (row.scrolls_here && row.is_selected) ImGui::SetScrollHereY(0.5F);
  ImGui::PopID();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 to(at.x + width, at.y + row.height);
  if (row.is_selected) {
    draw.AddRectFilled(at, to, IM_COL32(28, 74, 104, 255), ui.theme.px(6));
    draw.AddRect(at, to, kAccent, ui.theme.px(6), 0, ui.theme.px(2));
  } else if (hovered) {
    draw.AddRectFilled(at, to, IM_COL32(38, 47, 57, 255), ui.theme.px(6));
  }
  std::string word = row.name;  // the list of widgets is one of words
  std::replace(word.begin(), word.end(), ' ', '_');
  if (ImGui::IsRectVisible(at, to)) ui.log.note_button(word, at, to);
  ImGui::SetCursorScreenPos(at);
  ImGui::Dummy({width, row.height});
  return twice ? RowPress::Twice : once ? RowPress::Once : RowPress::None;
}

}  // namespace arthronaut::widgets
