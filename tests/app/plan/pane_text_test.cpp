#include "app/plan/pane_text.h"

#include <gtest/gtest.h>

namespace arthronaut::plan {
namespace {

constexpr widgets::Rect kPicture{100, 50, 400, 300};
const ImVec2 kText{60, 20};

void expect_at(const ImVec2& at, float x, float y) {
  EXPECT_EQ(at.x, x);
  EXPECT_EQ(at.y, y);
}

TEST(PaneText, StandsToTheRightOfItsPoint) { expect_at(beside({200, 150}, kText, 9, kPicture), 209, 150); }

// "40.7 mm" at the edge of a slice was read "40.7 m".
TEST(PaneText, IsNeverCutOffByTheEdge) {
  expect_at(beside({480, 345}, kText, 9, kPicture), 440, 330);
  expect_at(beside({20, 10}, kText, 9, kPicture), 100, 50);
}

// A picture that is smaller than the word shows its beginning.
TEST(PaneText, BeginsInAPictureThatIsTooSmall) {
  expect_at(beside({110, 60}, kText, 9, {100, 50, 30, 10}), 100, 50);
}

}  // namespace
}  // namespace arthronaut::plan
