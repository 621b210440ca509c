#include "planning/files/unit_signs.h"

#include <gtest/gtest.h>

namespace arthronaut::files {
namespace {

// Units as the rest of the screen has them; words that only begin alike stay.
TEST(UnitSigns, TakeThePlaceOfPlainLetters) {
  EXPECT_EQ(with_signs("Opening: 10.1 x 9.0 mm, 71 mm2, at 64 deg to the bone"),
            "Opening: 10.1 x 9.0 mm, 71 mm\u00b2, at 64\u00b0 to the bone");
  EXPECT_EQ(with_signs("28.4 +- 5.1 %; 75 deg"), "28.4 \u00b1 5.1 %; 75\u00b0");
  EXPECT_EQ(with_signs("3 degrees, comm2 and mm24"), "3 degrees, comm2 and mm24");
}

}  // namespace
}  // namespace arthronaut::files
