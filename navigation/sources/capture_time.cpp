#include "navigation/sources/capture_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace arthronaut::sources {

CaptureTime capture_time(double driver_ms, std::int64_t handed_over_ns) {
  constexpr double kOldest_ms = 2000;
  const double age_ms = static_cast<double>(handed_over_ns) * 1e-6 - driver_ms;
  // Written so that NaN is no stamp.
  if (!(driver_ms > 0) || !(age_ms >= 0 && age_ms <= kOldest_ms)) return {.ns = handed_over_ns};
  // By way of the age: a double holds it to the nanosecond, but not the time since the machine was started.
  return {.ns = handed_over_ns - std::llround(age_ms * 1e6), .clock = camera::CaptureClock::Driver};
}

void StreamClock::arrived(std::int64_t stamp_ns, std::int64_t arrived_ns) {
  // Pictures that are put in order by their decoder go back by less.
  constexpr std::int64_t kBack_ns = 500'000'000;
  // Two quartz clocks drift apart by less than 100 millionths. The estimate gives way twice as fast, so that
  // it follows a sender that runs slow.
  constexpr std::int64_t kDrift_ppm = 200;
  const std::int64_t apart_ns = arrived_ns - stamp_ns;
  if (!has_begun_ || stamp_ns < stamp_ns_ - kBack_ns) {
    has_begun_ = true;
    apart_ns_ = apart_ns;
  } else {
    apart_ns_ = std::min(apart_ns, apart_ns_ + (arrived_ns - at_ns_) * kDrift_ppm / 1'000'000);
  }
  stamp_ns_ = stamp_ns;
  at_ns_ = arrived_ns;
}

std::int64_t steady_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace arthronaut::sources
