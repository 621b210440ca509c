#include "navigation/guidance/drill_depth.h"

#include <gtest/gtest.h>

#include <limits>

#include "navigation/guidance/guidance.h"
#include "planning/geometry/error.h"

namespace arthronaut::guidance {
namespace {

tunnels::Tunnel plan() {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {3, 4, 5};
  tunnel.direction = Eigen::Vector3d(0.6, 0, 0.8);
  return tunnel;
}

constexpr double kRounding = 1e-9;

// The warning comes with the plan's exit, earlier where the depth is less well known.
TEST(DrillDepth, Hazard7WarnsBeforeTheFarSide) {
  EXPECT_EQ(breakout_of(12, 0.5), Breakout::Far);
  EXPECT_EQ(breakout_of(5.4, 0.5), Breakout::Near);
  EXPECT_EQ(breakout_of(2.4, 0.5), Breakout::Imminent);
  EXPECT_EQ(breakout_of(2.4, 0.1), Breakout::Near);
  EXPECT_EQ(breakout_of(0, 0), Breakout::Through);
  // A socket that ends 8 mm before the far side: all is drilled, and nothing breaks out.
  const PlannedDepth socket{.length_mm = 25, .exit_mm = 33};
  const DrillDepth drill = drill_depth(plan(), socket, plan().entry_mm + 25 * plan().direction,
                                       plan().direction, 0.5, DrillDepth::Source::Drill);
  EXPECT_NEAR(drill.remaining_mm, 0, kRounding);
  EXPECT_NEAR(drill.to_exit_mm, 8, kRounding);
  EXPECT_EQ(drill.breakout, Breakout::Far);
}

// Beside the plan its length says nothing about the bone there.
TEST(DrillDepth, Hazard7ADrillBesideThePlanIsNotAtIt) {
  const Eigen::Vector3d across = plan().direction.unitOrthogonal();
  const auto at = [&](double lateral_mm) {
    return drill_depth(plan(), {.length_mm = 30},
                       plan().entry_mm + 10 * plan().direction + lateral_mm * across, plan().direction, 0.5,
                       DrillDepth::Source::Drill);
  };
  EXPECT_TRUE(at(3).is_at_plan());
  EXPECT_FALSE(at(7).is_at_plan());
  EXPECT_NEAR(at(7).lateral_mm, 7, kRounding);
  EXPECT_NEAR(at(7).depth_mm, 10, kRounding);
}

// A drill without marker: what the stop reads stands out of the guide's end, along the guide.
TEST(DrillDepth, Hazard7TheDepthStopsReadingGivesWhatRemains) {
  GuidanceNumbers guide;
  EXPECT_FALSE(depth_from_stop(guide, plan(), {.length_mm = 30}, 20)) << "the guide is not seen";
  guide.state = GuidanceState::Valid;
  guide.guide_direction = plan().direction;
  guide.guide_point_mm = plan().entry_mm - 1.5 * plan().direction;  // not quite on the bone
  guide.sigma_offset_mm = 0.4;
  const auto drill = depth_from_stop(guide, plan(), {.length_mm = 30}, 20);
  ASSERT_TRUE(drill);
  EXPECT_EQ(drill->source, DrillDepth::Source::DepthStop);
  EXPECT_NEAR(drill->depth_mm, 18.5, kRounding);
  EXPECT_NEAR(drill->remaining_mm, 11.5, kRounding);
  EXPECT_GE(drill->sigma_mm, 0.5);  // a reading is no better than that
  EXPECT_THROW((void)depth_from_stop(guide, plan(), {.length_mm = 30}, 400), InvalidInput);
  EXPECT_THROW(
      (void)depth_from_stop(guide, plan(), {.length_mm = 30}, std::numeric_limits<double>::quiet_NaN()),
      InvalidInput);
}

}  // namespace
}  // namespace arthronaut::guidance
