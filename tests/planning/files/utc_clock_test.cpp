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

TEST(UtcClock, TimesAreReadAsPeopleWriteThem) {
  EXPECT_EQ(utc_in_words("2026-01-31T12:05:59Z"), "2026-01-31 12:05:59 UTC");
  for (const char* other : {"", "2026-01-31", "2026-01-31T12:05:59+02:00"})
    EXPECT_EQ(utc_in_words(other), other);
}

}  // namespace
}  // namespace arthronaut::files
