#include "app/review/slice_letters.h"

#include <imgui.h>

namespace arthronaut::review {

std::array<std::string, 4> side_letters(const scene::SlicePlane& plane) {
  return {scene::orientation_letters(-plane.right), scene::orientation_letters(plane.right),
          scene::orientation_letters(-plane.down), scene::orientation_letters(plane.down)};
}

void draw_side_letters(const widgets::Ui& ui, const widgets::Rect& picture, const scene::SlicePlane& plane) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* const font = ui.theme.strong;
  const float edge = ui.theme.px(6), high = font->FontSize, pad = ui.theme.px(3);
  const auto [left, right, top, bottom] = side_letters(plane);
  const float below_caption = high + ui.theme.px(18);  // what the picture is stands in its corner
  const auto put = [&](const std::string& letters, float share_x, float share_y, float lower = 0) {
    const float wide = font->CalcTextSizeA(high, 1e9F, 0, letters.c_str()).x;
    const ImVec2 at{picture.x + edge + share_x * (picture.width - wide - 2 * edge),
                    picture.y + edge + lower + share_y * (picture.height - high - 2 * edge)};
    draw.AddRectFilled({at.x - pad, at.y}, {at.x + wide + pad, at.y + high}, IM_COL32(12, 16, 20, 200), pad);
    draw.AddText(font, high, at, widgets::kCaution, letters.c_str());
  };
  put(left, 0, 0.5F);
  put(right, 1, 0.5F);
  put(top, 0.5F, 0, below_caption);
  put(bottom, 0.5F, 1);
  ui.log.note_state("slice_letters", left + " " + right + " " + top + " " + bottom);
}

}  // namespace arthronaut::review
