#include "navigation/worker/pace.h"

#include <gtest/gtest.h>

namespace arthronaut::worker {
namespace {

using std::chrono::milliseconds;
constexpr std::int64_t kMs = 1'000'000;
const Pace::Clock::time_point kStart{std::chrono::hours(48)};

// Each when its time stamp says, counted from the first; one that is behind goes on from there.
TEST(Pace, GoesByTheTimeStamps) {
  Pace pace;
  EXPECT_EQ(pace.due(5000 * kMs, kStart), kStart);
  EXPECT_EQ(pace.due(5040 * kMs, kStart + milliseconds(10)), kStart + milliseconds(40));
  EXPECT_EQ(pace.due(5080 * kMs, kStart + milliseconds(150)), kStart + milliseconds(80)) << "catches up";
  const auto behind = kStart + milliseconds(400);
  EXPECT_EQ(pace.due(5120 * kMs, behind), behind);
  EXPECT_EQ(pace.due(5160 * kMs, behind), behind + milliseconds(40)) << "slow motion, nothing left out";
}

// A camera that was off for an hour, or a sender's clock that jumped: nobody waits for that.
TEST(Pace, AGapIsNotWaitedFor) {
  Pace pace;
  (void)pace.due(0, kStart);
  const auto after = pace.due(3'600'000 * kMs, kStart);
  EXPECT_EQ(after, kStart + milliseconds(500));
  EXPECT_EQ(pace.due(3'600'040 * kMs, after), after + milliseconds(40)) << "and on at the same pace";
  EXPECT_EQ(pace.due(10 * kMs, after), after) << "back again";
}

}  // namespace
}  // namespace arthronaut::worker
