#include "navigation/strokes/curves.h"

#include <gtest/gtest.h>

namespace arthronaut::strokes {
namespace {

// The way from point to point of each stroke; from the end of one to the beginning of the next nothing was
// drawn.
TEST(Curves, LengthLeavesTheGapsOut) {
  EXPECT_EQ(length_mm({}), 0);
  const Curves curves{{0, std::nullopt, {0, 0, 0}},
                      {0, std::nullopt, {3, 4, 0}},
                      {2, std::nullopt, {100, 0, 0}},
                      {2, std::nullopt, {100, 0, 2}}};
  EXPECT_DOUBLE_EQ(length_mm(curves), 7);
}

}  // namespace
}  // namespace arthronaut::strokes
