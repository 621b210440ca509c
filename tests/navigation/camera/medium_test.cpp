#include "navigation/camera/medium.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"

namespace arthronaut::camera {

// The words and indices of the contract.
TEST(Medium, NamesTheContractsMedia) {
  EXPECT_EQ(refractive_index_from_text("air"), 1.0);
  EXPECT_EQ(refractive_index_from_text("water"), 1.333);
  EXPECT_EQ(refractive_index_from_text("saline"), 1.3345);
  EXPECT_EQ(refractive_index_from_text("1.34"), 1.34);
}

TEST(Medium, RefusesWhatIsNoMedium) {
  for (const char* text : {"", "milk", "0.5", "3", "1.3x", "nan", "-1.3", "inf"}) {
    EXPECT_THROW((void)refractive_index_from_text(text), InvalidInput) << text;
  }
}

TEST(Medium, TextRoundTrips) {
  for (const char* text : {"air", "water", "saline", "1.336", "1.33451234"}) {
    EXPECT_EQ(medium_to_text(refractive_index_from_text(text)), text);
  }
  const double third = 4.0 / 3;
  EXPECT_EQ(refractive_index_from_text(medium_to_text(third)), third);
}

}  // namespace arthronaut::camera
