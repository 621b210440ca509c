#include "app/widgets/hold_hint.h"

namespace arthronaut::widgets {

void draw_hold_hint(const Ui& ui, const Rect& window) {
  const std::string words = ui.actions.hold_words();
  ui.log.note_state("hold", words.empty() ? "" : ui.actions.is_held() ? words : words + " (let go)");
  if (words.empty()) return;
  constexpr float kQuarterTurn = 1.5707963F;
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  ImFont* const font = ui.theme.afar;
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str());
  const float height = ui.theme.px(96), width = size.x + ui.theme.px(150);
  // Over the buttons, never over a picture or a number.
  const Rect box{window.center().x - width / 2, window.y + window.height - height - ui.theme.px(48), width,
                 height};
  draw.AddRectFilled(box.min(), box.max(), IM_COL32(6, 8, 10, 244), ui.theme.px(10));
  draw.AddRect(box.min(), box.max(), kCaution, ui.theme.px(10), 0, ui.theme.px(3));
  const ImVec2 center{box.x + ui.theme.px(56), box.center().y};
  const float radius = ui.theme.px(30), line = ui.theme.px(10);
  draw.AddCircle(center, radius, kPanelEdge, 48, line);
  const float done = static_cast<float>(ui.actions.held_share());
  if (done > 0) {
    draw.PathArcTo(center, radius, -kQuarterTurn, -kQuarterTurn + 4 * kQuarterTurn * done, 48);
    draw.PathStroke(kCaution, 0, line);
  }
  draw.AddText(font, font->FontSize, {box.x + ui.theme.px(112), box.center().y - size.y / 2}, kText,
               words.c_str());
}

}  // namespace arthronaut::widgets
