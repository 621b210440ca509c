#include "app/widgets/tooltip.h"

#include "app/widgets/tooltip_place.h"
#include "app/widgets/wrapped_text.h"

namespace arthronaut::widgets {

void tooltip(const Ui& ui, const Rect& about, std::string_view text) {
  ImFont* const font = ui.theme.body;
  const std::string lines = wrapped(font, text, ui.theme.px(560));
  const ImVec2 words = font->CalcTextSizeA(font->FontSize, 1e9F, 0, lines.c_str()),
               padding = ImGui::GetStyle().WindowPadding, screen = ImGui::GetIO().DisplaySize;
  const ImVec2 size{words.x + 2 * padding.x, words.y + 2 * padding.y};
  const ImVec2 at = tooltip_place(about, size, {0, 0, screen.x, screen.y}, ui.theme.px(8), ui.log.buttons());
  ImGui::SetNextWindowPos(at);
  ImGui::BeginTooltip();
  ImGui::PushFont(font);
  ImGui::TextUnformatted(lines.data(), lines.data() + lines.size());
  ImGui::PopFont();
  ImGui::EndTooltip();
  ui.log.note("app.tooltip", at, {at.x + size.x, at.y + size.y});
}

void tooltip(const Ui& ui, std::string_view text) {
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  tooltip(ui, {min.x, min.y, max.x - min.x, max.y - min.y}, text);
}

void tooltip_at_mouse(const Ui& ui, std::string_view text) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float around = ui.theme.px(14);
  tooltip(ui, {mouse.x - around, mouse.y - around, 2 * around, 2 * around}, text);
}

}  // namespace arthronaut::widgets
