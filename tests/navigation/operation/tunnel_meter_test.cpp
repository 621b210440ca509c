#include "navigation/operation/tunnel_meter.h"

#include <gtest/gtest.h>

#include <random>

namespace arthronaut::operation {
namespace {

tunnels::Tunnel plan() {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {3, 4, 5};
  tunnel.direction = Eigen::Vector3d(-1, 0.2, 0.5).normalized();
  return tunnel;
}

guidance::GuidanceNumbers pose_at(double depth_mm, const Eigen::Vector3d& entry,
                                  const Eigen::Vector3d& direction) {
  guidance::GuidanceNumbers pose;
  pose.state = guidance::GuidanceState::Valid;
  pose.guide_direction = direction;
  pose.guide_point_mm = entry + depth_mm / direction.dot(plan().direction) * direction;
  pose.depth_mm = depth_mm;
  return pose;
}

// A drill that runs 1.5 mm beside the plan and leans is found again, from noisy poses and with the wild ones
// of the way in left out; the tolerance is the noise of a median over 60 poses.
TEST(TunnelMeter, FindsTheAxisOfTheDeepestPoses) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  const Eigen::Vector3d entry = plan().entry_mm + plan().direction.unitOrthogonal() * 1.5;
  const Eigen::Vector3d direction = (plan().direction + Eigen::Vector3d(0, 0.03, 0.01)).normalized();
  TunnelMeter meter;
  for (double depth = -10; depth < 30; depth += 0.5)
    meter.add(pose_at(depth, entry + Eigen::Vector3d(5, 5, 5), direction));
  for (int i = 0; i < 60; ++i)
    meter.add(pose_at(31, entry + Eigen::Vector3d(noise(random), noise(random), noise(random)), direction));
  const auto achieved = meter.measured(plan());
  ASSERT_TRUE(achieved);
  EXPECT_EQ(achieved->pose_count, 60);
  EXPECT_NEAR(achieved->depth_mm, 31, 1e-9);
  const Eigen::Vector3d miss = achieved->measured.entry_mm - entry;
  EXPECT_LT((miss - miss.dot(direction) * direction).norm(), 0.1);
  EXPECT_NEAR((achieved->measured.direction - direction).norm(), 0, 1e-9);
}

// A guide that only hovered, or touched for a moment, drilled nothing; poses that do not stand do not count.
TEST(TunnelMeter, NothingUnlessTheGuideStoodOnTheBone) {
  TunnelMeter meter;
  for (int i = 0; i < 50; ++i) meter.add(pose_at(-4, plan().entry_mm, plan().direction));
  for (int i = 0; i < 10; ++i) meter.add(pose_at(0, plan().entry_mm, plan().direction));
  guidance::GuidanceNumbers invalid = pose_at(30, plan().entry_mm, plan().direction);
  invalid.state = guidance::GuidanceState::GuideLost;
  for (int i = 0; i < 50; ++i) meter.add(invalid);
  EXPECT_FALSE(meter.measured(plan()));
}

}  // namespace
}  // namespace arthronaut::operation
