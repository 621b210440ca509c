#include "app/widgets/draw_pace.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::widgets {
namespace {

// Where the processor draws, three fifths of the time are the screen's at most: the rest is there for the
// pictures, and for a key, which then does not wait for a frame that has begun.
TEST(DrawPace, Hazard34LeavesTimeBesideTheFrames) {
  DrawPace pace(true);
  EXPECT_LE(pace.due_s(), 0) << "the first frame waits for nothing";
  pace.drawn(10, 10.012);
  EXPECT_NEAR(pace.due_s(), 10.020, 1e-9);
  pace.drawn(10.020, 10.041);
  EXPECT_NEAR(pace.due_s(), 10.055, 1e-9);
}

// However long a frame takes, the next one is not put off beyond 25 a second.
TEST(DrawPace, Hazard34NeverSlowsTheScreenBelowItsRate) {
  DrawPace pace(true);
  pace.drawn(10, 10.035);
  EXPECT_NEAR(pace.due_s(), 10.040, 1e-9);
  pace.drawn(10.040, 10.200);
  EXPECT_LE(pace.due_s(), 10.200) << "at once";
}

// A screen whose frames take 30 ms: pictures that come late get more of the time within half a second, and it
// is the screen's again once they do not.
TEST(DrawPace, Hazard34GivesWayToPicturesThatAreLate) {
  DrawPace pace(true);
  double now_s = 10;
  const auto frames_in = [&](double seconds, bool pictures_are_late) {
    int frames = 0;
    for (const double until_s = now_s + seconds; now_s < until_s; ++frames) {
      const double begun_s = std::max(now_s, pace.due_s());
      now_s = begun_s + 0.03;
      pace.drawn(begun_s, now_s, pictures_are_late);
    }
    return frames;
  };
  EXPECT_NEAR(frames_in(2, false), 50, 2);
  (void)frames_in(0.5, true);
  EXPECT_LE(frames_in(2, true), 20);
  EXPECT_GE(frames_in(2, true), 16) << "it goes on moving";
  (void)frames_in(8, false);
  EXPECT_NEAR(frames_in(2, false), 50, 2);
}

TEST(DrawPace, AGraphicsCardNeverWaits) {
  DrawPace pace(false);
  pace.drawn(10, 10.012);
  EXPECT_LE(pace.due_s(), 10);
}

TEST(MotionPace, DrawsWhatMovesTwelveTimesASecondByTheProcessor) {
  MotionPace by_processor, by_card;
  int drawn = 0, drawn_by_card = 0;
  for (int picture = 0; picture < 600; ++picture) {
    drawn += by_processor.is_due(picture / 60.0, true);
    drawn_by_card += by_card.is_due(picture / 60.0, false);
  }
  EXPECT_LE(drawn, 120);
  EXPECT_GE(drawn, 100) << "a picture that comes just too soon waits for the next one";
  EXPECT_EQ(drawn_by_card, 600);
}

}  // namespace
}  // namespace arthronaut::widgets
