// What the clock on the wall says of a moment in a file.
#include "planning/files/local_time.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

namespace arthronaut::files {
namespace {

class LocalTime : public ::testing::Test {
 protected:
  ~LocalTime() override { set_zone("UTC"); }
  static void set_zone(const char* zone) {
    ::setenv("TZ", zone, 1);
    ::tzset();
  }
};

// An hour ahead in winter, two in summer; the day is the room's.
TEST_F(LocalTime, IsTheWallsAndNotGreenwichs) {
  set_zone("CET-1CEST,M3.5.0,M10.5.0/3");
  EXPECT_EQ(local_time_in_words("2026-01-31T12:05:59Z"), "2026-01-31 13:05:59");
  EXPECT_EQ(local_time_in_words("2026-07-31T22:05:59Z"), "2026-08-01 00:05:59");
  EXPECT_EQ(local_day("2026-07-31T22:05:59Z"), "2026-08-01");
  EXPECT_EQ(local_day("2026-01-31T22:05:59Z"), "2026-01-31");
  set_zone("UTC");
  EXPECT_EQ(local_time_in_words("2026-01-31T12:05:59Z"), "2026-01-31 12:05:59");
}

TEST_F(LocalTime, OfWhatIsNoMomentIsSaidWhatThereIs) {
  set_zone("CET-1");
  EXPECT_EQ(local_time_in_words("2026-01-31"), "2026-01-31");
  EXPECT_EQ(local_day("2026-01-31"), "2026-01-31");
  EXPECT_EQ(local_day(""), "");
  EXPECT_EQ(local_time_in_words("yesterday"), "yesterday");
}

}  // namespace
}  // namespace arthronaut::files
