#include "planning/files/fixed_number.h"

#include <gtest/gtest.h>

namespace arthronaut::files {
namespace {

// What rounds to nothing has no sign; what does not keeps its own.
TEST(FixedNumber, NeverSaysMinusNought) {
  EXPECT_EQ(fixed(-0.004, 2), "0.00");
  EXPECT_EQ(fixed(-0.0, 1), "0.0");
  EXPECT_EQ(fixed(-0.4, 0), "0");
  EXPECT_EQ(fixed(-0.006, 2), "-0.01");
  EXPECT_EQ(fixed(-10, 0), "-10");
  EXPECT_EQ(fixed(0.04, 1), "0.0");
}

}  // namespace
}  // namespace arthronaut::files
