#include "planning/files/utc_clock.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <ctime>

namespace arthronaut::files {
namespace {

// Read back it is now, whatever time zone the machine lives in.
TEST(UtcClock, SaysNowInUtc) {
  ::setenv("TZ", "Asia/Tokyo", 1);
  ::tzset();
  const std::time_t before = std::time(nullptr);
  const std::string text = utc_now();
  std::tm parts{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  ASSERT_NE(end, nullptr) << text;
  EXPECT_EQ(*end, '\0') << text;
  const std::time_t said = ::timegm(&parts);
  EXPECT_GE(said, before);
  EXPECT_LE(said, std::time(nullptr));
  EXPECT_EQ(utc_now_as("%Y-%m").size(), 7U);
}

}  // namespace
}  // namespace arthronaut::files
