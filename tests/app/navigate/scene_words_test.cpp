#include "app/navigate/scene_words.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

constexpr float kLetters_px = 50, kGap_px = 12;

float width_of(const std::string& text) {
  const std::size_t line = text.find('\n');
  const auto wide = [](std::size_t letters) { return 26.F * static_cast<float>(letters); };
  return line == std::string::npos ? wide(text.size()) : wide(std::max(line, text.size() - line - 1));
}

SceneWords words_in(float width, float height, const std::string& colours = "Orange: draw here") {
  return scene_words({10, 20, width, height}, "Femur", colours, kLetters_px, kGap_px, width_of);
}

// The panes of a screen of 16:9 while the bone is registered and while it is drilled, a square, a tall one.
TEST(SceneWords, NameTheBoneInLettersForAfarAndLeaveItsView) {
  for (const ImVec2 size : {ImVec2{880, 214}, {428, 175}, {700, 700}, {428, 700}}) {
    SCOPED_TRACE(size.x);
    const SceneWords parts = words_in(size.x, size.y);
    EXPECT_TRUE(parts.words.starts_with("Femur")) << parts.words;
    EXPECT_GE(parts.place.width, width_of(parts.words));
    EXPECT_GE(parts.place.height, kLetters_px);
    const bool is_beside = parts.view.height == size.y;
    EXPECT_TRUE(is_beside ? parts.view.x >= parts.place.x + parts.place.width
                          : parts.view.y >= parts.place.y + parts.place.height);
    EXPECT_GE(parts.view.width, std::min(size.x, size.y) - 1);
    EXPECT_GT(parts.view.height, 0.9F * size.y - kLetters_px);
    EXPECT_LE(parts.view.x + parts.view.width, 10 + size.x + 1);
  }
}

TEST(SceneWords, TellTheColoursWhereThereIsRoom) {
  EXPECT_EQ(words_in(880, 214).words, "Femur\nOrange: draw here");
  EXPECT_EQ(words_in(700, 700).words, "Femur. Orange: draw here");
  EXPECT_EQ(words_in(428, 175).words, "Femur");
  EXPECT_EQ(words_in(880, 214, "").words, "Femur");
}

}  // namespace
}  // namespace arthronaut::navigate
