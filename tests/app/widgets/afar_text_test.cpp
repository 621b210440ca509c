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

// What somebody typed is shown as it was typed.
TEST(AfarText, BeginsWithACapitalUnlessItIsAnAddress) {
  EXPECT_EQ(sentence("open rtsp://tower/scope"), "Open rtsp://tower/scope");
  EXPECT_EQ(sentence("rtsp://tower/scope: Connection refused"), "rtsp://tower/scope: Connection refused");
  EXPECT_EQ(sentence("/dev/video0: no picture"), "/dev/video0: no picture");
  EXPECT_EQ(sentence(""), "");
}

}  // namespace
}  // namespace arthronaut::widgets
