#include "app/navigate/reached_plan.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

using operation::Grade;
using operation::GuidanceGrades;

constexpr GuidanceGrades kOn{Grade::Good, Grade::Good}, kOff{Grade::Bad, Grade::Good};

// Good for a while it is there, once; a number that trembles about its limit does not ring again and again.
TEST(ReachedPlan, IsToldOnceItStays) {
  ReachedPlan reached;
  reached.follow(kOn, 10);
  EXPECT_FALSE(reached.since(10)) << "it may only be passing";
  reached.follow(kOn, 10 + ReachedPlan::kSettles_s);
  ASSERT_TRUE(reached.since(10.5));
  EXPECT_LT(*reached.since(10.5), 0.2);
  reached.follow(kOff, 11);
  EXPECT_FALSE(reached.since(11)) << "off the plan is never called on it";
  reached.follow(kOn, 11.1);
  ASSERT_TRUE(reached.since(11.1));
  EXPECT_GT(*reached.since(11.1), 0.5) << "the moment was before";
  reached.follow(kOff, 12);
  reached.follow(kOff, 12 + ReachedPlan::kLeaves_s);
  reached.follow(kOn, 13);
  EXPECT_FALSE(reached.since(13));
  reached.follow(kOn, 13.5);
  EXPECT_TRUE(reached.since(13.5)) << "it came there again";
}

// Of offset and angle both count.
TEST(ReachedPlan, NeedsOffsetAndAngle) {
  for (const auto& [grades, is_there] :
       {std::pair(kOn, true), std::pair(kOff, false),
        std::pair(GuidanceGrades{Grade::Good, Grade::Bad}, false), std::pair(GuidanceGrades{}, false)}) {
    ReachedPlan reached;
    for (const double now_s : {0.0, 0.5, 1.0}) reached.follow(grades, now_s);
    EXPECT_EQ(reached.since(1).has_value(), is_there);
  }
}

// The numbers' own judgement and no second one: a grade that is held beside a number which is good by itself
// leaves the bullseye as it leaves the number, and one good picture among others has not come back.
TEST(ReachedPlan, IsNeverGreenBesideANumberThatIsNot) {
  operation::HeldGrades held;
  guidance::GuidanceNumbers numbers;
  numbers.state = guidance::GuidanceState::Valid;
  numbers.angle_deg = 0.5;
  numbers.sigma_offset_mm = numbers.sigma_angle_deg = 0.4;
  ReachedPlan reached;
  int green_count = 0;
  for (int i = 0; i < 240; ++i) {  // four seconds of 60 pictures, of which one in ten is over the limit
    numbers.offset_mm = i >= 120 && i % 10 == 0 ? 1.05 : 0.7;
    held.add(numbers, i * 16'666'667LL);
    reached.follow(held.grades(), i / 60.0);
    const bool is_green = reached.since(i / 60.0).has_value();
    green_count += is_green ? 1 : 0;
    ASSERT_TRUE(!is_green || held.grades().offset == Grade::Good) << i;
  }
  EXPECT_GT(green_count, 60) << "before it trembled it was there";
}

}  // namespace
}  // namespace arthronaut::navigate
