// What the pages of the start are drawn with.
#pragma once

#include <initializer_list>
#include <string>

#include "app/widgets/controls.h"

namespace arthronaut::start {

void draw_text(ImDrawList& draw, ImFont* font, float x, float y, ImU32 color, const std::string& words,
               float wrap = 0);
// Cut off with an ellipsis where it is too long.
[[nodiscard]] std::string fitting(ImFont* font, const std::string& words, float width);
// The actions' buttons side by side.
void draw_buttons(const widgets::Ui& ui, const widgets::Rect& bar, std::initializer_list<const char*> ids);

enum class RowPress { None, Once, Twice };
struct ListRow {
  std::string name;  // in the list of widgets
  std::size_t number = 0;
  float height = 0;
  bool is_selected = false, scrolls_here = false;
};
// A row of a list at ImGui's cursor: its background, and how it was pressed. What stands in it is drawn over
// it.
[[nodiscard]] RowPress draw_row(const widgets::Ui& ui, const ListRow& row);

}  // namespace arthronaut::start
