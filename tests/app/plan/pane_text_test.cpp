#include "app/plan/pane_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

// What stands in the picture until somebody has read it covers no handle, as long as it can stand elsewhere.
TEST(PaneText, ABoxStandsClearOfTheHandles) {
  constexpr widgets::Rect kUpper{100, 70, 300, 80}, kLower{100, 250, 300, 80};
  EXPECT_EQ(clear_place(kUpper, kLower, {}).y, kUpper.y);
  EXPECT_EQ(clear_place(kUpper, kLower, {{250, 200}, {50, 100}}).y, kUpper.y) << "beside and below it";
  EXPECT_EQ(clear_place(kUpper, kLower, {{250, 100}}).y, kLower.y);
  EXPECT_EQ(clear_place(kUpper, kLower, {{250, 100}, {250, 300}}).y, kUpper.y) << "one is covered anyway";
}

bool covers(const ImVec2& corner, const ImVec2& p) {
  return p.x > corner.x && p.x < corner.x + kText.x && p.y > corner.y && p.y < corner.y + kText.y;
}

// A number over its own line hid where the line ends; over an angle's sides, how they run.
TEST(PaneText, OfAMeasurementCoversNoneOfItsLines) {
  const ImVec2 vertex(300, 200);
  for (int turn = 0; turn < 36; ++turn)
    for (const int opening : {0, 4, 9, 14}) {  // in tens of degrees; 0: a distance
      const auto on = [&](int tens, float length) {
        const auto angle = static_cast<float>(tens) * 3.14159265F / 18;
        return ImVec2(vertex.x + length * std::cos(angle), vertex.y + length * std::sin(angle));
      };
      std::vector<ImVec2> points{on(turn, 45), vertex};
      if (opening > 0) points.push_back(on(turn + opening, 45));
      const ImVec2 at = beside_measured(points, kText, 6, kPicture);
      for (std::size_t side = 0; side + 1 < points.size(); ++side)
        for (int i = 0; i <= 90; ++i) {
          const float share = static_cast<float>(i) / 90;
          const ImVec2 p(points[side].x + share * (points[side + 1].x - points[side].x),
                         points[side].y + share * (points[side + 1].y - points[side].y));
          ASSERT_FALSE(covers(at, p)) << "turned by " << 10 * turn << ", opening " << 10 * opening;
        }
    }
}

TEST(PaneText, OfAMeasurementIsNeverCutOffByTheEdge) {
  const ImVec2 at = beside_measured({{480, 60}, {495, 120}}, kText, 6, kPicture);
  EXPECT_GE(at.x, kPicture.x);
  EXPECT_LE(at.x + kText.x, kPicture.x + kPicture.width);
}

// In the small picture beside the slices the words of entry, exit and landmarks ran over each other and over
// the right edge.
TEST(PaneText, OfSignsThatAreCloseKeepApart) {
  std::vector<ImVec4> taken;
  const float right = kPicture.x + kPicture.width, bottom = kPicture.y + kPicture.height;
  for (int i = 0; i < 6; ++i) {
    const auto off = static_cast<float>(i);
    const ImVec2 at =
        free_place({right - kText.x - 20 + 3 * off, bottom - 120 + 2 * off}, kText, 12, kPicture, taken);
    EXPECT_GE(at.x, kPicture.x) << i;
    EXPECT_LE(at.x + kText.x, right) << i;
    EXPECT_LE(at.y + kText.y, bottom) << i;
  }
  ASSERT_EQ(taken.size(), 6U);
  for (std::size_t i = 0; i < taken.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_FALSE(taken[i].x < taken[k].z && taken[k].x < taken[i].z && taken[i].y < taken[k].w &&
                   taken[k].y < taken[i].w)
          << i << " over " << k;
}

// One of many numbers stands right beside its point, or is left out: a line off it would be another's.
TEST(PaneText, ANumberAmongManyIsNeverFarFromItsPoint) {
  std::vector<ImVec4> taken;
  const ImVec2 point(kPicture.x + 200, kPicture.y + 100);
  const auto place = [&] { return free_place_on({0}, point, kText, 12, kPicture, taken); };
  const auto right = place(), left = place();
  ASSERT_TRUE(right && left);
  EXPECT_EQ(right->x, point.x + 12);
  EXPECT_EQ(left->x, point.x - 12 - kText.x);
  EXPECT_EQ(right->y, left->y);
  EXPECT_FALSE(place());
  EXPECT_EQ(taken.size(), 2U) << "what is left out takes no place";
}

// A picture that is smaller than the word shows its beginning.
TEST(PaneText, BeginsInAPictureThatIsTooSmall) {
  expect_at(beside({110, 60}, kText, 9, {100, 50, 30, 10}), 100, 50);
}

}  // namespace
}  // namespace arthronaut::plan
