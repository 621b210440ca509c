// Text that must be read from across the room: in the letters for that (theme.h), broken over lines. What
// does not fit is set smaller rather than cut off; that it was, is told to the tests.
#pragma once

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

// The largest of the theme's letters in which the text fits the area: those for afar, else title, else
// strong; strong where it fits in none.
[[nodiscard]] ImFont* font_that_fits(const Theme& theme, float width, float height, std::string_view text);
// Height of the text at this width, in the letters for afar.
[[nodiscard]] float afar_height(const Ui& ui, float width, std::string_view text);
// The words with a capital at their beginning, but for an address, which has its own letters.
[[nodiscard]] std::string sentence(std::string words);
// From the upper left corner. Returns the height drawn.
float draw_afar(const Ui& ui, const Rect& area, ImU32 color, std::string_view text);

}  // namespace arthronaut::widgets
