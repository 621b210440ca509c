#include "app/widgets/draw_pace.h"

#include <gtest/gtest.h>

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
