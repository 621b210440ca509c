#include "navigation/sources/capture_time.h"

#include <gtest/gtest.h>

#include <limits>

namespace arthronaut::sources {
namespace {

using camera::CaptureClock;

// Two days after the machine was started.
constexpr std::int64_t kNow_ns = 172'800'000'000'000 + 123'456'789;

// A stamp of the driver is the capture time, to a microsecond, in which V4L2 counts.
TEST(LatePicture, IsAsOldAsTheDriversStampSays) {
  for (const double age_ms : {0.0, 16.7, 350.0, 1999.0}) {
    const CaptureTime captured = capture_time(static_cast<double>(kNow_ns) * 1e-6 - age_ms, kNow_ns);
    EXPECT_EQ(captured.clock, CaptureClock::Driver) << age_ms;
    EXPECT_NEAR(static_cast<double>(kNow_ns - captured.ns), age_ms * 1e6, 1000) << age_ms;
  }
}

// No stamp, one of the future, one of the wall clock or of long ago: then only the moment of handing over is
// known, and it is said that it is that.
TEST(LatePicture, TakesTheHandingOverWhereTheStampCannotBeTrue) {
  const double now_ms = static_cast<double>(kNow_ns) * 1e-6;
  for (const double driver_ms :
       {0.0, -1.0, now_ms + 5, 1.79e12, now_ms - 5000, std::numeric_limits<double>::quiet_NaN()}) {
    const CaptureTime captured = capture_time(driver_ms, kNow_ns);
    EXPECT_EQ(captured.clock, CaptureClock::HandedOver) << driver_ms;
    EXPECT_EQ(captured.ns, kNow_ns) << driver_ms;
  }
}

}  // namespace
}  // namespace arthronaut::sources
