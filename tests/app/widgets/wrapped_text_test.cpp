#include "app/widgets/wrapped_text.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

class WrappedText : public ::testing::Test {
 protected:
  // Every letter of ImGui's own font is as wide as the next.
  WrappedText() : font_(fonts_.AddFontDefault()) { fonts_.Build(); }
  [[nodiscard]] std::string in_letters(std::string_view text, int count) const {
    const float letter = font_->CalcTextSizeA(font_->FontSize, 1e9F, 0, "0").x;
    return wrapped(font_, text, (static_cast<float>(count) + 0.5F) * letter);
  }
  ImFontAtlas fonts_;
  ImFont* font_;
};

// A number that is broken at its point reads as two: 75 and 0 degrees.
TEST_F(WrappedText, BreaksNoNumber) {
  EXPECT_EQ(in_letters("longest at 75.0 deg", 14), "longest at\n75.0 deg");
  EXPECT_EQ(in_letters("20.5,7.3 mm", 6), "20.5,7.3 mm") << "though it is too wide";
}

// "No new picture for 7" and, below it, "s".
TEST_F(WrappedText, KeepsANumberWithItsUnit) {
  EXPECT_EQ(in_letters("picture for 15 s", 14), "picture for\n15 s");
  EXPECT_EQ(in_letters("7.0 mm wide, 34.4 mm, long", 17), "7.0 mm wide,\n34.4 mm, long");
  EXPECT_EQ(in_letters("3 to go", 3), "3\nto\ngo") << "no unit";
  EXPECT_EQ(in_letters("7\nmm", 9), "7\nmm");
}

TEST_F(WrappedText, KeepsWhatFitsAndItsLineEnds) {
  EXPECT_EQ(in_letters("one two", 7), "one two");
  EXPECT_EQ(in_letters("one two", 6), "one\ntwo");
  EXPECT_EQ(in_letters("one\ntwo three", 9), "one\ntwo three");
  EXPECT_EQ(in_letters("one\n\ntwo", 9), "one\n\ntwo");
  EXPECT_EQ(in_letters("one  two\n", 9), "one  two\n");
  EXPECT_EQ(in_letters("", 9), "");
}

// A message that is too long for its line is set smaller, and then in as many lines as there is room for;
// only what even so has no room is cut, and its end says so.
TEST_F(WrappedText, IsShownWholeInTheRoomThereIs) {
  const float letter = font_->CalcTextSizeA(font_->FontSize, 1e9F, 0, "0").x, height = font_->FontSize;
  const auto within = [&](std::string_view text, int letters, float lines) {
    return lines_within(font_, text, (static_cast<float>(letters) + 0.1F) * letter, lines * height);
  };
  EXPECT_EQ(within("one two", 7, 1).lines, "one two");
  EXPECT_EQ(within("one two", 7, 1).letters_px, height);
  EXPECT_EQ(within("one two", 6, 2).lines, "one\ntwo");
  const LinesWithin smaller = within("one two", 6, 1);
  EXPECT_EQ(smaller.lines, "one two");
  EXPECT_LT(smaller.letters_px, height);
  const LinesWithin cut = within("one two three four five", 7, 1);
  EXPECT_TRUE(cut.lines.starts_with("one two")) << cut.lines;
  EXPECT_TRUE(cut.lines.ends_with("\u2026")) << cut.lines;
  EXPECT_EQ(within("", 7, 1).lines, "");
}

}  // namespace
}  // namespace arthronaut::widgets
