#include "navigation/guidance/drill_depth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

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
  const DrillDepth drill =
      drill_depth(plan(), 25, plan().entry_mm + 20 * plan().direction, plan().direction, 0.5);
  EXPECT_NEAR(drill.remaining_mm, 5, kRounding);
  EXPECT_EQ(drill.to_exit_mm, drill.remaining_mm);
  EXPECT_EQ(drill.breakout, Breakout::Near);
}

// Beside the plan its length says nothing about the bone there.
TEST(DrillDepth, Hazard7ADrillBesideThePlanIsNotAtIt) {
  const Eigen::Vector3d across = plan().direction.unitOrthogonal();
  const auto at = [&](double lateral_mm) {
    return drill_depth(plan(), 30, plan().entry_mm + 10 * plan().direction + lateral_mm * across,
                       plan().direction, 0.5);
  };
  EXPECT_TRUE(at(3).is_at_plan());
  EXPECT_FALSE(at(7).is_at_plan());
  EXPECT_NEAR(at(7).lateral_mm, 7, kRounding);
  EXPECT_NEAR(at(7).depth_mm, 10, kRounding);
}

// Aslant the plan's length says nothing either, long before the tip has left it: 15 degrees off through the
// entry the drill comes out 8 mm beside the exit of a tunnel of 30 mm.
TEST(DrillDepth, Hazard7ADrillThatHeadsElsewhereIsNotAtThePlan) {
  const Eigen::Vector3d along = plan().direction, side = along.unitOrthogonal();
  const auto turned = [&](double angle_deg, double depth_mm) {
    const double angle = geometry::rad_from_deg(angle_deg);
    const Eigen::Vector3d direction = std::cos(angle) * along + std::sin(angle) * side;
    return drill_depth(plan(), 30, plan().entry_mm + depth_mm / std::cos(angle) * direction, direction, 0.5);
  };
  EXPECT_NEAR(turned(15, 2).exit_lateral_mm, 30 * std::tan(geometry::rad_from_deg(15)), kRounding);
  EXPECT_NEAR(turned(15, 12).exit_lateral_mm, 30 * std::tan(geometry::rad_from_deg(15)), kRounding);
  EXPECT_TRUE(turned(15, 2).is_beside_plan());
  EXPECT_FALSE(turned(15, 2).is_at_plan());
  EXPECT_TRUE(turned(5, 2).is_at_plan());
  EXPECT_TRUE(turned(170, 2).is_beside_plan()) << "the wrong way round";
}

}  // namespace
}  // namespace arthronaut::guidance
