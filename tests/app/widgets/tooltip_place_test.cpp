#include "app/widgets/tooltip_place.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

constexpr Rect kScreen{0, 0, 1920, 1080};
constexpr float kGap = 8;

bool overlaps(const Rect& a, const Rect& b) {
  return a.x < b.max().x && b.x < a.max().x && a.y < b.max().y && b.y < a.max().y;
}

// Of every button of a screen: a row at the bottom, two at the top, and a panel of pairs at the right.
TEST(TooltipPlace, CoversNoButtonWhicheverIsSpokenOf) {
  std::vector<Rect> buttons;
  for (int i = 0; i < 7; ++i) {
    buttons.push_back({12 + 210.F * i, 972, 200, 56});
    buttons.push_back({12 + 170.F * i, 84, 160, 42});
    buttons.push_back({12 + 170.F * i, 136, 160, 42});
  }
  for (int i = 0; i < 5; ++i)
    for (int side = 0; side < 2; ++side) buttons.push_back({1454 + 225.F * side, 700 + 52.F * i, 213, 42});
  for (const Rect& about : buttons)
    for (const ImVec2 size : {ImVec2{380, 52}, ImVec2{590, 130}}) {
      const ImVec2 at = tooltip_place(about, size, kScreen, kGap, buttons);
      const Rect place{at.x, at.y, size.x, size.y};
      for (const Rect& button : buttons) EXPECT_FALSE(overlaps(place, button)) << about.x << " " << about.y;
      EXPECT_GE(place.x, 0);
      EXPECT_GE(place.y, 0);
      EXPECT_LE(place.max().x, kScreen.width);
      EXPECT_LE(place.max().y, kScreen.height);
    }
}

// Alone on the screen it stands as near as the gap lets it.
TEST(TooltipPlace, IsNear) {
  const Rect about{800, 500, 200, 50};
  const ImVec2 at = tooltip_place(about, {300, 60}, kScreen, kGap, {about});
  const bool is_beside = at.x == about.max().x + kGap || at.x + 300 == about.x - kGap;
  const bool is_above_or_below = at.y == about.max().y + kGap || at.y + 60 == about.y - kGap;
  EXPECT_TRUE(is_beside || is_above_or_below) << at.x << " " << at.y;
}

// Where nothing is free it is on the screen all the same.
TEST(TooltipPlace, StaysOnTheScreen) {
  const ImVec2 at = tooltip_place({0, 0, 100, 100}, {80, 40}, {0, 0, 100, 100}, kGap, {{0, 0, 100, 100}});
  EXPECT_GE(at.x, 0);
  EXPECT_LE(at.x + 80, 100);
  EXPECT_LE(at.y + 40, 100);
}

}  // namespace
}  // namespace arthronaut::widgets
