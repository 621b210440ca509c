#include "navigation/guidance/guidance_counts.h"

#include <gtest/gtest.h>

namespace arthronaut::guidance {
namespace {

// Where most frames had guidance nobody asks why; where most had none, the two commonest reasons say it.
TEST(GuidanceCounts, SayWhyMostFramesHadNone) {
  GuidanceCounts counts;
  EXPECT_EQ(counts.reasons_of_most(), "");
  const auto add = [&](GuidanceState state, int count) {
    for (int i = 0; i < count; ++i) counts.add(state);
  };
  add(GuidanceState::Valid, 5);
  add(GuidanceState::LensStale, 2);
  add(GuidanceState::GuideLost, 3);
  EXPECT_EQ(counts.of(GuidanceState::Valid), 5);
  EXPECT_EQ(counts.reasons_of_most(), "") << "half of them had";
  add(GuidanceState::WorldMarkerLost, 1);
  EXPECT_EQ(counts.reasons_of_most(), "drill guide not seen (3), lens mark not seen (2)");
  GuidanceCounts one;
  one.add(GuidanceState::NoPlan);
  EXPECT_EQ(one.reasons_of_most(), "no plan (1)");
}

}  // namespace
}  // namespace arthronaut::guidance
