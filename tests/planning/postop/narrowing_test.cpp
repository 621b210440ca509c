#include "planning/postop/narrowing.h"

#include <gtest/gtest.h>

#include <vector>

namespace arthronaut::postop {
namespace {

constexpr double kLength_mm = 4;

// As wide as said, each known to 0.05 mm; 0: not seen.
std::vector<Stretch> stretches(const std::vector<double>& widths_mm) {
  std::vector<Stretch> all;
  for (const double width_mm : widths_mm) {
    Stretch stretch;
    stretch.from_entry_mm = kLength_mm * (static_cast<double>(all.size()) + 0.5);
    stretch.diameter_mm = width_mm;
    stretch.noise_sigma_mm = 0.05;
    stretch.seen_share = width_mm > 0 ? 1 : 0;
    all.push_back(stretch);
  }
  return all;
}

// The share of both widths within a stretch tells where in it the one becomes the other.
TEST(Narrowing, IsWhereTheWidthsChangeForGood) {
  EXPECT_NEAR(*narrows_at_mm(stretches({8, 8, 8, 8, 4.5, 4.5})), 16, 1e-9);
  EXPECT_NEAR(*narrows_at_mm(stretches({8, 8, 8, 6.25, 4.5, 4.5})), 14, 1e-9);
  EXPECT_NEAR(*narrows_at_mm(stretches({8, 8, 8, 5.2, 4.5, 0})), 12.8, 1e-9);
}

TEST(Narrowing, IsNotSeenInAnEvenATaperedOrABarelySeenBore) {
  EXPECT_FALSE(narrows_at_mm(stretches({8, 8.1, 7.9, 8, 8})));
  EXPECT_FALSE(narrows_at_mm(stretches({10.7, 10.1, 9.5, 8.9, 8.3, 8, 8}))) << "widened at the entry";
  EXPECT_FALSE(narrows_at_mm(stretches({8, 8, 4.5, 8, 8}))) << "thin in one place alone";
  EXPECT_FALSE(narrows_at_mm(stretches({8, 8, 8, 0, 0})));
  EXPECT_FALSE(narrows_at_mm(stretches({8, 4.5, 4.5})));
  EXPECT_FALSE(narrows_at_mm({}));
}

}  // namespace
}  // namespace arthronaut::postop
