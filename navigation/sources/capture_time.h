// When a picture of a device was taken: the driver's stamp where it can be true.
//
// V4L2 drivers stamp a picture on the monotonic clock, which is std::chrono::steady_clock on Linux. Some
// stamp nothing, some on the wall clock, and the interface that passes the stamp on does not say which; so a
// stamp is believed only when it lies in the last two seconds.
#pragma once

#include <cstdint>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

struct CaptureTime {
  std::int64_t ns = 0;  // on std::chrono::steady_clock
  camera::CaptureClock clock = camera::CaptureClock::HandedOver;
};

// driver_ms: what the driver says, 0 when it says nothing. handed_over_ns: when the picture came, on the
// steady clock.
[[nodiscard]] CaptureTime capture_time(double driver_ms, std::int64_t handed_over_ns);

[[nodiscard]] std::int64_t steady_now_ns();

}  // namespace arthronaut::sources
