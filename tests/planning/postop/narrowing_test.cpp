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
  EXPECT_NEAR(narrowing_of(stretches({8, 8, 8, 8, 4.5, 4.5}))->from_entry_mm, 16, 1e-9);
  EXPECT_NEAR(narrowing_of(stretches({8, 8, 8, 6.25, 4.5, 4.5}))->from_entry_mm, 14, 1e-9);
  EXPECT_NEAR(narrowing_of(stretches({8, 8, 8, 5.2, 4.5, 0}))->from_entry_mm, 12.8, 1e-9);
  EXPECT_EQ(narrowing_of(stretches({8, 8, 8, 5.2, 4.5, 0}))->thinner_mm, 4.5);
}

// A socket of 6 mm has no bore beyond it that is thinner by 2 mm: 3 to 27 mm of the loop's bore were told as
// its length.
TEST(Narrowing, IsSeenOfAThinSocket) {
  EXPECT_NEAR(narrowing_of(stretches({6.2, 6.1, 6.2, 6.1, 6.1, 5.0, 4.3, 0}))->from_entry_mm, 21.5, 0.1);
}

TEST(Narrowing, IsNotSeenInAnEvenATaperedOrABarelySeenBore) {
  EXPECT_FALSE(narrowing_of(stretches({8, 8.1, 7.9, 8, 8})));
  EXPECT_FALSE(narrowing_of(stretches({10.7, 10.1, 9.5, 8.9, 8.3, 8, 8}))) << "widened at the entry";
  EXPECT_FALSE(narrowing_of(stretches({12.3, 11, 9.7, 9, 9, 9}))) << "widened at the entry alone";
  EXPECT_FALSE(narrowing_of(stretches({8, 8, 4.5, 8, 8}))) << "thin in one place alone";
  EXPECT_FALSE(narrowing_of(stretches({8, 8, 8, 0, 0})));
  EXPECT_FALSE(narrowing_of(stretches({8, 4.5, 4.5})));
  EXPECT_FALSE(narrowing_of({}));
}

}  // namespace
}  // namespace arthronaut::postop
