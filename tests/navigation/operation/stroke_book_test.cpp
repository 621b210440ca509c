#include "navigation/operation/stroke_book.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::operation {
namespace {

// Draws along x, a point every 0.2 mm and 1/60 s, from a place and a time on.
void draw(StrokeBook& strokes, double from_s, const Eigen::Vector3d& from_mm, double length_mm) {
  for (double at = 0; at <= length_mm; at += 0.2)
    strokes.add(from_s + at / 0.2 / 60, from_mm + Eigen::Vector3d(at, 0, 0));
}

// A stroke ends where tracking was gone or the tip hopped, and what is too short to say anything is not used.
TEST(StrokeBook, CutsAtGapsAndHops) {
  StrokeBook strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 1, 0}, 8);    // a gap
  draw(strokes, 5.7, {0, 5, 0}, 6);  // a hop
  draw(strokes, 9, {0, 9, 0}, 0.6);  // a crumb
  EXPECT_EQ(strokes.points().back().curve, 3);
  EXPECT_EQ(strokes.in_use().back().curve, 2);
}

// Another source counts its time from nothing: no stroke goes on across that.
TEST(StrokeBook, CutsWhereTimeRunsBackwards) {
  StrokeBook strokes;
  draw(strokes, 5, {0, 0, 0}, 4);
  EXPECT_EQ(strokes.add(0, strokes.points().back().position_mm).curve, 1);
}

// Taking back goes stroke by stroke; the crumbs after a stroke go with it, since nobody sees them as strokes.
// What is drawn next is a stroke of its own with a number of its own.
TEST(StrokeBook, TakesBackTheLastStroke) {
  StrokeBook strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 5, 0}, 10);
  draw(strokes, 9, {0, 9, 0}, 0.6);
  EXPECT_EQ(strokes.take_back(), 2);
  EXPECT_EQ(strokes.points().back().curve, 0);
  const double just_after = *strokes.points().back().time_s + 0.01;
  EXPECT_EQ(strokes.add(just_after, strokes.points().back().position_mm).curve, 3);
  strokes.take_back();
  EXPECT_TRUE(strokes.points().empty());
  EXPECT_TRUE(strokes.trace()->empty());
  EXPECT_EQ(strokes.take_back(), 0);
}

// A stroke that is excluded stays drawn and can come back.
TEST(StrokeBook, ExcludesAndTakesIn) {
  StrokeBook strokes;
  draw(strokes, 0, {0, 0, 0}, 10);
  draw(strokes, 5, {0, 5, 0}, 10);
  const std::size_t all = strokes.in_use().size();
  strokes.exclude(0, true);
  EXPECT_FALSE(strokes.uses(0));
  EXPECT_TRUE(strokes.uses(1));
  EXPECT_FALSE(strokes.uses(7));
  EXPECT_EQ(strokes.in_use().front().curve, 1);
  EXPECT_EQ(strokes.points().front().curve, 0);
  EXPECT_EQ(strokes.trace()->front().curve, 0);
  strokes.exclude(0, false);
  EXPECT_EQ(strokes.in_use().size(), all);
}

// An hour at 60 Hz on the same patch of bone, and one on ever new bone: all points are kept, and what the
// screen is given is bounded at every moment. Many points later it is handed the very same trace: drawing
// over what was drawn makes nothing anew.
TEST(StrokeBook, TheTraceOfAnHourOfDrawingIsBounded) {
  constexpr int kHour = 216'000;
  StrokeBook same, wide;
  std::size_t most = 0;
  for (int i = 0; i < kHour; ++i) {
    const double at = i / 60.0;
    same.add(at, {8 * std::sin(at), 8 * std::cos(1.3 * at), std::sin(0.2 * at)});
    const int row = i / 500;
    wide.add(at, {(row % 2 == 0 ? i % 500 : 499 - i % 500) * 0.6, row * 0.6, 0});
    most = std::max({most, same.trace()->size(), wide.trace()->size()});
  }
  EXPECT_EQ(same.points().size(), static_cast<std::size_t>(kHour));
  EXPECT_EQ(wide.points().size(), static_cast<std::size_t>(kHour));
  EXPECT_LE(most, StrokeBook::kMostTraced);
  EXPECT_GT(wide.trace()->size(), StrokeBook::kMostTraced / 3);
  EXPECT_EQ(wide.trace()->back().curve, wide.points().back().curve) << "the newest is drawn";
  const TracePtr before = same.trace();
  const Eigen::Vector3d place = same.points()[1000].position_mm;
  for (int i = 0; i < 1000; ++i) same.add(kHour / 60.0 + i / 60.0, place);
  EXPECT_EQ(same.trace(), before);
  // What stepped off the screen is there again when it is drawn again.
  for (int i = 0; i < 20; ++i) wide.add(kHour / 60.0 + i / 60.0, wide.points()[i].position_mm);
  EXPECT_LT(wide.trace()->back().position_mm.x(), 20 * 0.6);
  EXPECT_LT(wide.trace()->back().position_mm.y(), 0.6);
}

}  // namespace
}  // namespace arthronaut::operation
