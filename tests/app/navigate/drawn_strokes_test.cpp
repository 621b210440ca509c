#include "app/navigate/drawn_strokes.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

// Draws along x, a point every 0.2 mm and 1/60 s, from a place and a time on.
void draw(DrawnStrokes& strokes, double from_s, const Eigen::Vector3d& from_mm, double length_mm) {
  for (double at = 0; at <= length_mm; at += 0.2)
    strokes.add(from_s + at / 0.2 / 60, from_mm + Eigen::Vector3d(at, 0, 0));
}

// A stroke ends where tracking was gone or the tip hopped, and what is too short to say anything is not used.
TEST(DrawnStrokes, CutsAtGapsAndHops) {
  DrawnStrokes strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 1, 0}, 8);    // a gap
  draw(strokes, 5.7, {0, 5, 0}, 6);  // a hop
  draw(strokes, 9, {0, 9, 0}, 0.6);  // a crumb
  EXPECT_EQ(strokes.points().back().curve, 3);
  EXPECT_EQ(strokes.in_use().back().curve, 2);
}

// Taking back goes stroke by stroke; the crumbs after a stroke go with it, since nobody sees them as strokes.
// What is drawn next is a stroke of its own with a number of its own.
TEST(DrawnStrokes, TakesBackTheLastStroke) {
  DrawnStrokes strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 5, 0}, 10);
  draw(strokes, 9, {0, 9, 0}, 0.6);
  EXPECT_EQ(strokes.take_back(), 2);
  EXPECT_EQ(strokes.points().back().curve, 0);
  const double just_after = *strokes.points().back().time_s + 0.01;
  EXPECT_EQ(strokes.add(just_after, strokes.points().back().position_mm).curve, 3);
  strokes.take_back();
  EXPECT_TRUE(strokes.points().empty());
  EXPECT_EQ(strokes.take_back(), 0);
}

// A stroke that is left out stays drawn and can come back.
TEST(DrawnStrokes, LeavesOutAndTakesIn) {
  DrawnStrokes strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 5, 0}, 10);
  const std::size_t all = strokes.in_use().size();
  strokes.leave_out(0, true);
  EXPECT_EQ(strokes.in_use().front().curve, 1);
  EXPECT_EQ(strokes.points().front().curve, 0);
  strokes.leave_out(0, false);
  EXPECT_EQ(strokes.in_use().size(), all);
}

}  // namespace
}  // namespace arthronaut::navigate
