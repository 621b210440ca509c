#include "app/window/key_list.h"

#include <algorithm>
#include <string>

#include "app/widgets/list_rows.h"

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
  // As many as there are stand on the screen, and none runs into its neighbour.
  const float most = (size.y - ui.theme.px(20)) / static_cast<float>(rows + 2);
  const float line = std::min(ui.theme.px(34), most);
  const float letters = std::min(ui.theme.body->FontSize, 0.9F * line);
  const float key_width = ui.theme.px(150), column_width = std::min(ui.theme.px(900), size.x / 2);
  const float left = (size.x - static_cast<float>(columns) * column_width) / 2;
  const float top = std::max((size.y - line * static_cast<float>(rows + 2)) / 2, ui.theme.px(10));
  draw.AddText(ui.theme.title, ui.theme.title->FontSize, {left, top}, widgets::kText, "Keys (F10 closes)");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float x = left + static_cast<float>(i / rows) * column_width;
    const float y = top + line * static_cast<float>(i % rows + 2);
    const std::string key = widgets::key_name(shown[i]->key, shown[i]->mods);
    draw.AddText(ui.theme.strong, letters, {x, y}, widgets::kAccent, key.c_str());
    const float room = (column_width - key_width - ui.theme.px(16)) * ui.theme.body->FontSize / letters;
    const std::string words =
        widgets::fitting(ui.theme.body, shown[i]->label + ": " + shown[i]->tooltip, room);
    draw.AddText(ui.theme.body, letters, {x + key_width, y}, widgets::kText, words.c_str());
  }
}

}  // namespace arthronaut::window
