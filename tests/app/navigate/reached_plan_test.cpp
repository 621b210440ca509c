#include "app/navigate/reached_plan.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

guidance::GuidanceNumbers at(double offset_mm, double angle_deg) {
  guidance::GuidanceNumbers numbers;
  numbers.state = guidance::GuidanceState::Valid;
  numbers.offset_mm = numbers.offset_anterior_mm = offset_mm;
  numbers.angle_deg = angle_deg;
  numbers.sigma_offset_mm = numbers.sigma_angle_deg = 0.2;
  return numbers;
}

// Good for a while it is there, once; a number that trembles about its limit does not ring again and again.
TEST(ReachedPlan, IsToldOnceItStays) {
  ReachedPlan reached;
  reached.follow(at(0.3, 0.5), 10);
  EXPECT_FALSE(reached.since(10)) << "it may only be passing";
  reached.follow(at(0.3, 0.5), 10 + ReachedPlan::kSettles_s);
  ASSERT_TRUE(reached.since(10.5));
  EXPECT_LT(*reached.since(10.5), 0.2);
  reached.follow(at(3, 0.5), 11);
  EXPECT_FALSE(reached.since(11)) << "off the plan is never called on it";
  reached.follow(at(0.3, 0.5), 11.1);
  ASSERT_TRUE(reached.since(11.1));
  EXPECT_GT(*reached.since(11.1), 0.5) << "the moment was before";
  reached.follow(at(3, 0.5), 12);
  reached.follow(at(3, 0.5), 12 + ReachedPlan::kLeaves_s);
  reached.follow(at(0.3, 0.5), 13);
  EXPECT_FALSE(reached.since(13));
  reached.follow(at(0.3, 0.5), 13.5);
  EXPECT_TRUE(reached.since(13.5)) << "it came there again";
}

// Of offset and angle both count, and how well they are known.
TEST(ReachedPlan, NeedsOffsetAngleAndCertainty) {
  for (const auto& [numbers, is_there] :
       {std::pair(at(0.3, 0.5), true), std::pair(at(3, 0.5), false), std::pair(at(0.3, 9), false)}) {
    ReachedPlan reached;
    for (const double now_s : {0.0, 0.5, 1.0}) reached.follow(numbers, now_s);
    EXPECT_EQ(reached.since(1).has_value(), is_there);
  }
  guidance::GuidanceNumbers unsure = at(0.3, 0.5);
  unsure.sigma_offset_mm = 2.5;
  ReachedPlan reached;
  for (const double now_s : {0.0, 0.5, 1.0}) reached.follow(unsure, now_s);
  EXPECT_FALSE(reached.since(1));
}

}  // namespace
}  // namespace arthronaut::navigate
