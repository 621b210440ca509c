#include "app/review_view/session_review.h"

#include <gtest/gtest.h>

namespace arthronaut::review_view {
namespace {

// Stretches cover exactly what held, and gaps of up to `bridge` frames are closed.
TEST(SessionReview, StretchesBridgeShortGaps) {
  const std::vector<bool> holds{true, true, false, true, false, false, false, true};
  const auto stretches = stretches_of(holds, 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].first, 0U);
  EXPECT_EQ(stretches[0].last, 3U);
  EXPECT_EQ(stretches[1].first, 7U);
  EXPECT_EQ(stretches[1].last, 7U);
  EXPECT_TRUE(stretches_of({false, false}, 3).empty());
  EXPECT_TRUE(stretches_of({}, 3).empty());
}

}  // namespace
}  // namespace arthronaut::review_view
