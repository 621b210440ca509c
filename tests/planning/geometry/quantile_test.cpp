#include "planning/geometry/quantile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::geometry {
namespace {

// The ends, the middle, and the rank below where a share falls between two.
TEST(Quantile, IsAValueOfTheList) {
  const std::vector<double> values{5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 0.7), 3);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(median(values), 3);
  EXPECT_EQ(median({4, 1, 3, 2}), 3);
}

// Of nothing there is none, or what the caller says.
TEST(Quantile, OfNothingIsNotKnown) {
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_EQ(quantile({}, 0.95, -1), -1);
  EXPECT_EQ(median({}, 0), 0);
}

}  // namespace
}  // namespace arthronaut::geometry
