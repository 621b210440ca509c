// Rows of a list that are chosen by key or mouse, and what they are drawn with.
#pragma once

#include <initializer_list>
#include <string>

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

void draw_text(ImDrawList& draw, ImFont* font, float x, float y, ImU32 color, const std::string& words,
               float wrap = 0);
// Cut off with an ellipsis where it is too long.
[[nodiscard]] std::string fitting(ImFont* font, const std::string& words, float width);
// The same at its beginning: of a path the end tells which it is.
[[nodiscard]] std::string fitting_end(ImFont* font, const std::string& words, float width);
// Scrolls the list (ImGui's window) to the row that was drawn last, from `top_px` on, where it is another one
// than the last time and not all in sight; never else, or a hand could not scroll.
void bring_into_sight(std::size_t row, float top_px, float height_px);
// The actions' buttons side by side.
void draw_buttons(const Ui& ui, const Rect& bar, std::initializer_list<const char*> ids);

enum class RowPress { None, Once, Twice };
struct ListRow {
  std::string name;  // in the list of widgets
  std::size_t number = 0;
  float height = 0;
  bool is_selected = false, scrolls_here = false;
};
// A row of a list at ImGui's cursor: its background, and how it was pressed. What stands in it is drawn over
// it.
[[nodiscard]] RowPress draw_row(const Ui& ui, const ListRow& row);

}  // namespace arthronaut::widgets
