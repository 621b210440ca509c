#include "app/widgets/hold_hint.h"

namespace arthronaut::widgets {

void draw_hold_hint(const Ui& ui, const Rect& window, const std::optional<Rect>& header) {
  const std::string words = ui.actions.hold_words();
  ui.log.note_state("hold", words.empty() ? "" : ui.actions.is_held() ? words : words + " (let go)");
  if (words.empty()) return;
  constexpr float kQuarterTurn = 1.5707963F;
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  const Rect& room = header ? *header : window;
  const auto width_in = [&](ImFont* font) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x + ui.theme.px(150);
  };
  ImFont* const font = width_in(ui.theme.afar) <= room.width ? ui.theme.afar : ui.theme.title;
  const float height = ui.theme.px(96), width = width_in(font);
  const float top = header ? header->y + header->height : window.y + window.height - height - ui.theme.px(48);
  const Rect box{room.center().x - width / 2, top, width, height};
  ui.log.note("hold_hint", box.min(), box.max());
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
  draw.AddText(font, font->FontSize, {box.x + ui.theme.px(112), box.center().y - font->FontSize / 2}, kText,
               words.c_str());
}

}  // namespace arthronaut::widgets
