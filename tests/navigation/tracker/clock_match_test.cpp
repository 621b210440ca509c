#include "navigation/tracker/clock_match.h"

#include <gtest/gtest.h>

#include <random>

namespace arthronaut::tracker {
namespace {

constexpr std::int64_t kBegin_ns = 5'000'000'000'000;
constexpr double kUtc_s = 1.8e9;

std::int64_t ns(double s) { return kBegin_ns + static_cast<std::int64_t>(s * 1e9); }

// Messages at 60 Hz that take 2 ms and now and then up to 40 more; the sender's clock runs so far ahead.
class ClockMatchTest : public ::testing::TestWithParam<double> {};

TEST_P(ClockMatchTest, AgeIsTheTruthWhateverTheClocksDiffer) {
  const double ahead_s = GetParam();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> wait(0, 0.04);
  ClockMatch match(0.004);  // the round trip
  for (int i = 0; i < 300; ++i) {
    const double taken_s = i / 60.0;
    const double arrived_s = taken_s + 0.002 + (i % 3 == 0 ? 0 : wait(random));
    const double stamp_s = kUtc_s + taken_s + ahead_s;
    match.add(stamp_s, ns(arrived_s));
    if (!match.is_known()) continue;
    const double age_s = match.age_s(stamp_s, ns(arrived_s + 0.01));
    const double true_s = arrived_s + 0.01 - taken_s;
    // Never younger than it is, and older by no more than the round trip: 2 ms of it were truly spent.
    EXPECT_GE(age_s, true_s - 1e-5);
    EXPECT_LE(age_s, true_s + 0.0021);
  }
  EXPECT_TRUE(match.is_known());
}

INSTANTIATE_TEST_SUITE_P(Clocks, ClockMatchTest, ::testing::Values(0.0, 3600.0, -3600.0, 0.5));

// Half a second of messages is too little to know that one of them came straight.
TEST(ClockMatch, IsNotKnownAtOnce) {
  ClockMatch match;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(match.is_known(), i > 30) << i;
    match.add(kUtc_s + i / 60.0, ns(i / 60.0));
  }
}

// A queue that fills up makes messages old, however evenly they come.
TEST(ClockMatch, ABacklogNeverLooksNew) {
  ClockMatch match;
  for (int i = 0; i < 120; ++i) match.add(kUtc_s + i / 60.0, ns(i / 60.0));
  // From now on everything waits for two seconds, for ten minutes.
  double age_s = 0;
  for (int i = 120; i < 36'000; ++i) {
    match.add(kUtc_s + i / 60.0, ns(i / 60.0 + 2));
    age_s = match.age_s(kUtc_s + i / 60.0, ns(i / 60.0 + 2));
    ASSERT_GT(age_s, 1.9);
  }
  EXPECT_LT(age_s, 2.01);
}

// Stamps that stand still, and a clock that is set back, look old.
TEST(ClockMatch, StampsThatStandStillLookOld) {
  ClockMatch match;
  for (int i = 0; i < 120; ++i) match.add(kUtc_s, ns(i / 60.0));
  EXPECT_NEAR(match.age_s(kUtc_s, ns(2)), 2, 1e-3);
  ClockMatch set_back;
  for (int i = 0; i < 120; ++i) set_back.add(kUtc_s + i / 60.0, ns(i / 60.0));
  set_back.add(kUtc_s - 3600 + 2, ns(2));
  EXPECT_NEAR(set_back.age_s(kUtc_s - 3600 + 2, ns(2)), 3600, 1e-3);
}

// Two clocks that run apart by 50 millionths, for an hour.
TEST(ClockMatch, FollowsClocksThatRunApart) {
  for (const double apart : {5e-5, -5e-5}) {
    ClockMatch match;
    for (int i = 0; i < 36'000; ++i) {
      const double at_s = i / 10.0;
      match.add(kUtc_s + at_s * (1 + apart), ns(at_s));
      ASSERT_NEAR(match.age_s(kUtc_s + at_s * (1 + apart), ns(at_s)), 0, 1e-4);
    }
  }
}

}  // namespace
}  // namespace arthronaut::tracker
