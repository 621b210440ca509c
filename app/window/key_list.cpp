#include "app/window/key_list.h"

#include <algorithm>

namespace arthronaut::window {

void draw_key_list(const widgets::Ui& ui, const std::vector<std::string_view>& prefixes) {
  std::vector<const widgets::Action*> shown;
  for (const widgets::Action& action : ui.actions.all()) {
    const bool here = std::any_of(prefixes.begin(), prefixes.end(),
                                  [&](std::string_view prefix) { return action.id.starts_with(prefix); });
    if (here && action.key != 0) shown.push_back(&action);
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({0, 0}, size, IM_COL32(6, 8, 10, 244));
  const std::size_t columns = 2, rows = (shown.size() + columns - 1) / columns;
  const float line = ui.theme.px(34), key_width = ui.theme.px(150), column_width = ui.theme.px(900);
  const float left = (size.x - static_cast<float>(columns) * column_width) / 2;
  const float top = std::max((size.y - line * static_cast<float>(rows + 2)) / 2, ui.theme.px(10));
  draw.AddText(ui.theme.title, ui.theme.title->FontSize, {left, top}, widgets::kText, "Keys (F10 closes)");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float x = left + static_cast<float>(i / rows) * column_width;
    const float y = top + line * static_cast<float>(i % rows + 2);
    const std::string key = widgets::key_name(shown[i]->key, shown[i]->mods);
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {x, y}, widgets::kAccent, key.c_str());
    draw.AddText(ui.theme.body, ui.theme.body->FontSize, {x + key_width, y}, widgets::kText,
                 (shown[i]->label + ": " + shown[i]->tooltip).c_str());
  }
}

}  // namespace arthronaut::window
