#include "planning/files/format.h"

#include <gtest/gtest.h>

namespace arthronaut::files {
namespace {

// As printf, and whole however long it gets.
TEST(Format, PutsNumbersIntoSentences) {
  EXPECT_EQ(format("%d of %.1f mm", 3, 2.25), "3 of 2.2 mm");
  EXPECT_EQ(format("nothing"), "nothing");
  const std::string name(1000, 'x');
  EXPECT_EQ(format("%s: %d", name.c_str(), 7), name + ": 7");
}

}  // namespace
}  // namespace arthronaut::files
