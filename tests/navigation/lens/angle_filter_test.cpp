#include "navigation/lens/angle_filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::lens {
namespace {

// A lens that turns steadily through 0 is followed within the measurement's own error.
TEST(AngleFilter, FollowsThroughZero) {
  AngleFilter filter;
  for (int i = 0; i < 60; ++i) {
    filter.predict(1.0 / 60);
    filter.update(std::fmod(350.0 + 1.5 * i, 360.0), 0.1);
  }
  EXPECT_NEAR(std::remainder(filter.angle_deg() - (350 + 1.5 * 59), 360.0), 0, 0.1);
}

// Unseen, the angle is kept and its doubt grows.
TEST(AngleFilter, DoubtGrowsWhileNothingIsSeen) {
  AngleFilter filter;
  EXPECT_FALSE(filter.is_running());
  EXPECT_DOUBLE_EQ(filter.sigma_deg(), 360);
  for (int i = 0; i < 30; ++i) {
    filter.predict(1.0 / 60);
    filter.update(45, 0.1);
  }
  EXPECT_LT(filter.sigma_deg(), 0.2);
  filter.predict(0.5);
  EXPECT_NEAR(filter.angle_deg(), 45, 1);
  EXPECT_GT(filter.sigma_deg(), 20);
}

}  // namespace
}  // namespace arthronaut::lens
