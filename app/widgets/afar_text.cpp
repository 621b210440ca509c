#include "app/widgets/afar_text.h"

#include <array>
#include <cctype>

#include "app/widgets/wrapped_text.h"

namespace arthronaut::widgets {

namespace {

ImVec2 size_of(ImFont* font, float width, std::string_view text) {
  const std::string lines = wrapped(font, text, width);
  return font->CalcTextSizeA(font->FontSize, 1e9F, width, lines.data(), lines.data() + lines.size());
}

}  // namespace

std::string sentence(std::string words) {
  const bool is_address = words.substr(0, words.find(' ')).find("://") != std::string::npos;
  if (!words.empty() && !is_address)
    words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

ImFont* font_that_fits(const Theme& theme, float width, float height, std::string_view text) {
  for (ImFont* const font : std::array{theme.afar, theme.title}) {
    const ImVec2 size = size_of(font, width, text);
    // A word that is longer than the line is broken within; it does not count as fitting.
    if (size.y <= height + 1 && size.x <= width + 1) return font;
  }
  return theme.strong;
}

float afar_height(const Ui& ui, float width, std::string_view text) {
  return text.empty() ? 0 : size_of(ui.theme.afar, width, text).y;
}

float draw_afar(const Ui& ui, const Rect& area, ImU32 color, std::string_view text) {
  if (text.empty() || area.width < 1) return 0;
  ImFont* const font = font_that_fits(ui.theme, area.width, area.height, text);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec4 clip{area.x, area.y, area.x + area.width, area.y + area.height};
  const std::string lines = wrapped(font, text, area.width);
  draw.AddText(font, font->FontSize, area.min(), color, lines.data(), lines.data() + lines.size(), area.width,
               &clip);
  return size_of(font, area.width, text).y;
}

}  // namespace arthronaut::widgets
