#include "app/widgets/afar_text.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

// "28." at the end of a line is another number than 28.4: what would fit if numbers were broken does not.
TEST(AfarText, BreaksNoNumber) {
  ImFontAtlas fonts;
  Theme theme;
  theme.afar = fonts.AddFontDefault();  // every letter as wide as the next
  theme.title = theme.strong = fonts.AddFontDefault();
  fonts.Build();
  const float line = theme.afar->FontSize;
  const float letter = theme.afar->CalcTextSizeA(line, 1e9F, 0, "0").x;
  const std::string_view words = "aaaaaa 2.4 bbbbbb";
  EXPECT_EQ(font_that_fits(theme, 9.5F * letter, 3 * line, words), theme.afar);
  EXPECT_EQ(font_that_fits(theme, 9.5F * letter, 2 * line, words), theme.strong);
}

}  // namespace
}  // namespace arthronaut::widgets
