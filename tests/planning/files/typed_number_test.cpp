#include "planning/files/typed_number.h"

#include <gtest/gtest.h>

namespace arthronaut::files {

TEST(TypedNumber, HasAPointOrACommaAndMayHaveItsUnit) {
  for (const char* text : {"21.5", "21,5", " 21.5 ", "21,5 mm", "21.5mm"})
    EXPECT_EQ(typed_number(text, "mm"), 21.5) << text;
  EXPECT_EQ(typed_number("-3", ""), -3.0);
}

TEST(TypedNumber, IsNothingElse) {
  for (const char* text : {"", "mm", "1.234,5", "12,5,", "1e999", "nan", "inf", "0x10", "12 cm", "about 3"})
    EXPECT_FALSE(typed_number(text, "mm")) << text;
}

}  // namespace arthronaut::files
