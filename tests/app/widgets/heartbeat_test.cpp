#include "app/widgets/heartbeat.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

// The mark stands elsewhere in every frame: what does not move was not drawn.
TEST(HeartbeatHazard17, MovesWithEveryFrame) {
  Heartbeat heartbeat;
  int before = heartbeat.place();
  for (int i = 0; i < 100; ++i) {
    heartbeat.beat(i * 0.02, true);
    EXPECT_NE(heartbeat.place(), before);
    EXPECT_LT(heartbeat.place(), Heartbeat::kPlaces);
    before = heartbeat.place();
  }
  EXPECT_EQ(heartbeat.words(), "");
}

// A gap of more than half a second while an operation runs is told in the next frame, with its length, and
// for a while.
TEST(HeartbeatHazard17, TellsThatTheScreenStoodStill) {
  Heartbeat heartbeat;
  heartbeat.beat(10.0, true);
  heartbeat.beat(11.2, true);
  EXPECT_EQ(heartbeat.words(), "The screen stood still for 1.2 s");
  double now_s = 11.2;
  for (; now_s < 20; now_s += 0.1) heartbeat.beat(now_s, true);
  EXPECT_FALSE(heartbeat.words().empty());
  for (; now_s < 22; now_s += 0.1) heartbeat.beat(now_s, true);
  EXPECT_TRUE(heartbeat.words().empty());
}

// Waiting for a user is no standstill, and neither is the start of an operation.
TEST(HeartbeatHazard17, IsSilentWhileNothingRuns) {
  Heartbeat heartbeat;
  heartbeat.beat(10, false);
  heartbeat.beat(15, true);
  EXPECT_EQ(heartbeat.stood_still_s(), 0);
  heartbeat.beat(15.4, true);
  EXPECT_EQ(heartbeat.stood_still_s(), 0);
}

}  // namespace
}  // namespace arthronaut::widgets
