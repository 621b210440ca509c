#include "navigation/simulator/holding.h"

#include <gtest/gtest.h>

namespace arthronaut::simulator {
namespace {

// The probe's tip stands where it was put and its marker lies in the direction of the hand; the marker faces
// the viewer.
TEST(HoldProbe, PutsTheTipAndShowsTheMarker) {
  const Eigen::Vector3d tip_in_probe(0, -22.8, -13.1), tip(4, -9, 12), hold(10, -2, -7), viewer(-3, 1, -30);
  const auto pose = hold_probe(tip_in_probe, tip, hold, viewer);
  ASSERT_TRUE(pose);
  EXPECT_LT((*pose * tip_in_probe - tip).norm(), 1e-9);
  const Eigen::Vector3d towards = (pose->translation_mm - tip).normalized();
  EXPECT_LT(geometry::angle_between_rad(towards, hold - tip), 1e-6);
  const double tilt =
      geometry::angle_between_rad(pose->rotate(Eigen::Vector3d::UnitZ()), viewer - pose->translation_mm);
  EXPECT_LT(geometry::deg_from_rad(tilt), 60);
}

// Turning stops at the limit, and does nothing within it.
TEST(TurnedTowards, KeepsTheLimit) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(geometry::angle_between_rad(turned_towards(x, y, 0.4), y), 0.4, 1e-12);
  EXPECT_EQ(turned_towards(x, y, 2.0), x);
}

// The guide's point and axis lie where they were asked for, whoever looks at it.
TEST(GuidePose, LaysTheAxisThroughThePoint) {
  const tools::ToolAxis axis{{0, -24, -3.3}, -Eigen::Vector3d::UnitY()};
  const Eigen::Vector3d point(3, -7, 11), direction = Eigen::Vector3d(0.7, -0.4, 0.6).normalized();
  for (const Eigen::Vector3d& viewer : {Eigen::Vector3d(0, 0, 40), Eigen::Vector3d(-30, 5, -20)}) {
    const geometry::RigidTransform pose = guide_pose(axis, point, direction, viewer);
    EXPECT_LT((pose * axis.point_mm - point).norm(), 1e-9);
    EXPECT_LT((pose.rotate(axis.direction) - direction).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace arthronaut::simulator
