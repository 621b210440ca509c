#include "planning/files/utc_clock.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
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

// Written and read back, across a leap day; what is no time of this program's is none.
TEST(UtcClock, ReadsWhatItWrote) {
  using namespace std::chrono;
  const sys_seconds moment = sys_days(2028y / February / 29) + 23h + 59min + 58s;
  EXPECT_EQ(time_of_utc(utc_of(moment)), moment);
  EXPECT_EQ(time_of_utc("2028-03-01"), moment + 2s);
  for (const char* none : {"", "2026-02-29", "2026-13-01", "2026-01-31T", "2026-01-31T24:00:00Z", "2026-1-31",
                           "2026-01-31T12:00:00.5Z", "2026-01-31T12:00:00+02:00", "2026-01-31 12:00:00"})
    EXPECT_EQ(time_of_utc(none), std::nullopt) << none;
}

TEST(UtcClock, TimesAreReadAsPeopleWriteThem) {
  EXPECT_EQ(utc_in_words("2026-01-31T12:05:59Z"), "2026-01-31 12:05:59 UTC");
  for (const char* other : {"", "2026-01-31", "2026-01-31T12:05:59+02:00"})
    EXPECT_EQ(utc_in_words(other), other);
}

}  // namespace
}  // namespace arthronaut::files
