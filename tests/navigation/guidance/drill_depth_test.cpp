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

geometry::TriangleMesh block(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                  i & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}
geometry::TriangleMesh together(geometry::TriangleMesh a, const geometry::TriangleMesh& b) {
  const auto first = static_cast<std::int32_t>(a.vertices_mm.size());
  a.vertices_mm.insert(a.vertices_mm.end(), b.vertices_mm.begin(), b.vertices_mm.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

// The bone that the drill is in ends where it ends, whatever was planned.
TEST(DrillDepth, Hazard7TheExitIsThatOfTheDrillsOwnAxis) {
  const geometry::Surface bone(block({0, -30, -30}, {20, 30, 30}));
  const Eigen::Vector3d x(1, 0, 0), aslant = Eigen::Vector3d(1, 0, 1).normalized();
  const auto at = [&](double tip, const Eigen::Vector3d& direction) {
    return to_exit_along(bone, {tip, 1, 2}, direction);
  };
  EXPECT_NEAR(*at(12, x), 8, 1e-2);
  EXPECT_NEAR(*at(12, aslant), 8 * std::sqrt(2), 1e-2);
  EXPECT_NEAR(*at(-5, x), 25, 1e-2) << "before it goes in";
  EXPECT_NEAR(*at(20.5, x), -0.5, 1e-2);
  EXPECT_NEAR(*at(45, x), -25, 1e-2);
  EXPECT_NEAR(*at(-5, -x), -5, 1e-2) << "from the other side";
  EXPECT_FALSE(to_exit_along(bone, {-5, 1, 2}, {0, 1, 0})) << "beside it";
  EXPECT_FALSE(to_exit_along(bone, {10, 50, 0}, x)) << "past it";
}

// The surface is rough where the drill begins, and a pose that is a little off grazes what the drill passes.
TEST(DrillDepth, Hazard7WhatIsThinIsNotWhatTheDrillIsIn) {
  const Eigen::Vector3d x(1, 0, 0);
  const geometry::Surface rough(
      together(block({-4, -30, -30}, {-2, 30, 30}), block({0, -30, -30}, {20, 30, 30})));
  for (const double tip : {-6.0, -3.0, -1.0, 2.0})
    EXPECT_NEAR(*to_exit_along(rough, {tip, 1, 2}, x), 20 - tip, 0.02) << tip;
  const geometry::Surface grazed(
      together(block({-30, -30, -30}, {-24, 30, 30}), block({0, -30, -30}, {20, 30, 30})));
  EXPECT_NEAR(*to_exit_along(grazed, {-5, 1, 2}, x), 25, 0.02) << "what lies behind it was not drilled";
  EXPECT_NEAR(*to_exit_along(grazed, {-26, 1, 2}, x), 2, 0.02) << "and is bone while the drill is in it";
}

// At the plan and beside it the nearer end counts.
TEST(DrillDepth, Hazard7WarnsBesideThePlan) {
  const geometry::Surface bone(block({-20, -30, -30}, {20, 30, 30}));
  tunnels::Tunnel planned;
  planned.entry_mm = {-20, 0, 0};
  planned.direction = {1, 0, 0};
  const auto at = [&](const Eigen::Vector3d& tip, double length_mm) {
    DrillDepth drill = drill_depth(planned, length_mm, tip, planned.direction, 0.4);
    hold_against(bone, drill);
    return drill;
  };
  EXPECT_NEAR(at({10, 3, 0}, 35).to_exit_mm, 5, 1e-2) << "where the plan ends";
  EXPECT_NEAR(at({10, 3, 0}, 48).to_exit_mm, 10, 1e-2) << "where bone ends";
  EXPECT_NEAR(at({10, 3, 0}, 48).remaining_mm, 18, 1e-2);
  const DrillDepth beside = at({18.5, 9, 0}, 60);
  EXPECT_TRUE(beside.is_beside_plan());
  EXPECT_NEAR(beside.to_exit_mm, 1.5, 1e-2);
  EXPECT_EQ(beside.breakout, Breakout::Imminent);
  EXPECT_EQ(at({21, 9, 0}, 60).breakout, Breakout::Through);
  EXPECT_EQ(at({0, 9, 0}, 20).breakout, Breakout::Far) << "the plan's end is not its own";
  // Without the bone nobody knows.
  const DrillDepth unknown = drill_depth(planned, 20, {0, 9, 0}, planned.direction, 0.4);
  EXPECT_TRUE(std::isnan(unknown.to_exit_mm));
  EXPECT_EQ(unknown.breakout, Breakout::Far);
}

}  // namespace
}  // namespace arthronaut::guidance
