// Which registration of all strokes is waited for, and what ends that.
#include "navigation/operation/stroke_fit.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

// Goes on with one stroke, ten millimetres in a second.
void draw_on(StrokeBook& strokes, int points, double from_s = 0) {
  for (int i = 0; i < points; ++i) {
    const double time_s = from_s + 0.02 * i;
    (void)strokes.add(time_s, {10 * time_s, 0, 0});
  }
}

TEST(StrokeFit, IsOfTheStrokesThatItWasAskedOf) {
  StrokeBook strokes;
  StrokeFit fit;
  EXPECT_FALSE(fit.ask(strokes)) << "there are none";
  draw_on(strokes, 100);
  const auto asked = fit.ask(strokes);
  ASSERT_TRUE(asked);
  fit.asked_with(7);
  EXPECT_TRUE(fit.is_under_way());
  EXPECT_EQ(fit.request(), 7U);
  EXPECT_NEAR(fit.length_mm(), 19.8, 0.1);
  EXPECT_TRUE(fit.tried(strokes));
  EXPECT_FALSE(fit.has_come(asked->number - 1)) << "that is another one";
  EXPECT_TRUE(fit.has_come(asked->number));
  EXPECT_FALSE(fit.is_under_way());
  EXPECT_TRUE(fit.tried(strokes));
}

TEST(StrokeFit, OneOfOtherStrokesIsWaitedForAndNotTaken) {
  StrokeBook strokes;
  StrokeFit fit;
  draw_on(strokes, 100);
  const auto asked = fit.ask(strokes);
  ASSERT_TRUE(asked);
  strokes.clear();
  fit.on_strokes_cleared();
  EXPECT_TRUE(fit.is_under_way()) << "the next one has to wait for its end";
  EXPECT_EQ(fit.length_mm(), 0);
  EXPECT_FALSE(fit.has_come(asked->number));
  EXPECT_FALSE(fit.is_under_way());
}

// As many points as before are not the strokes of before.
TEST(StrokeFit, OtherStrokesOfTheSameLengthWereNotTried) {
  StrokeBook strokes;
  StrokeFit fit;
  draw_on(strokes, 100);
  ASSERT_TRUE(fit.ask(strokes));
  strokes.clear();
  fit.on_strokes_cleared();
  draw_on(strokes, 100, 10);
  EXPECT_FALSE(fit.tried(strokes));
  const auto asked = fit.ask(strokes);
  ASSERT_TRUE(asked && fit.has_come(asked->number));
  (void)strokes.take_back();
  fit.on_strokes_gone();
  draw_on(strokes, 100, 20);
  EXPECT_FALSE(fit.tried(strokes));
}

// What was excluded and taken in again while it was under way is not waited for: nobody knows what it gave.
TEST(StrokeFit, WhatWasNotTakenInWasNotTried) {
  StrokeBook strokes;
  StrokeFit fit;
  draw_on(strokes, 100);
  const auto exclude_and_take_in = [&] {
    for (const bool is_excluded : {true, false}) {
      strokes.exclude(0, is_excluded);
      fit.on_strokes_excluded();
    }
  };
  auto asked = fit.ask(strokes);
  exclude_and_take_in();
  EXPECT_FALSE(fit.has_come(asked->number));
  EXPECT_FALSE(fit.tried(strokes));
  asked = fit.ask(strokes);
  EXPECT_TRUE(fit.has_come(asked->number));
  exclude_and_take_in();
  EXPECT_TRUE(fit.tried(strokes)) << "the same again gives the same";
  fit.on_aim();
  EXPECT_FALSE(fit.tried(strokes)) << "at another plan another verdict may come of them";
}

TEST(StrokeFit, WhereTheBoneFailsNoneWillCome) {
  StrokeBook strokes;
  StrokeFit fit;
  draw_on(strokes, 100);
  ASSERT_TRUE(fit.ask(strokes));
  fit.on_failure();
  EXPECT_FALSE(fit.is_under_way());
}

TEST(NowAndThen, IsTwiceASecondByAnyClock) {
  NowAndThen looks;
  EXPECT_TRUE(looks.is_time(1'000'000'000));
  EXPECT_FALSE(looks.is_time(1'499'999'999));
  EXPECT_TRUE(looks.is_time(1'500'000'000));
  EXPECT_TRUE(looks.is_time(5)) << "another source has another clock";
}

}  // namespace
}  // namespace arthronaut::operation
