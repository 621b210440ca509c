#include "navigation/sources/capture_time.h"

#include <chrono>
#include <cmath>

namespace arthronaut::sources {

CaptureTime capture_time(double driver_ms, std::int64_t handed_over_ns) {
  constexpr double kOldest_ms = 2000;
  const double age_ms = static_cast<double>(handed_over_ns) * 1e-6 - driver_ms;
  // Written so that NaN is no stamp.
  if (!(driver_ms > 0) || !(age_ms >= 0 && age_ms <= kOldest_ms)) return {.ns = handed_over_ns};
  // By way of the age: a double holds it to the nanosecond, but not the time since the machine was started.
  return {.ns = handed_over_ns - std::llround(age_ms * 1e6), .clock = camera::CaptureClock::Driver};
}

std::int64_t steady_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace arthronaut::sources
