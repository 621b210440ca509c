// When each picture of a recording or a simulation is due: at its own pace. Faster sources wait, slower ones
// run in slow motion rather than leave pictures out, since every one may carry a touched point. A gap in the
// time stamps is passed over in half a second: nobody waits for a camera that was off for an hour.
#pragma once

#include <chrono>
#include <cstdint>

namespace arthronaut::worker {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  // When the picture with this timestamp is due, which now is there. May lie in the past by a tenth of a
  // second, and in the future by half of one.
  Clock::time_point due(std::int64_t timestamp_ns, Clock::time_point now = Clock::now()) {
    const Clock::time_point due = start_ + std::chrono::nanoseconds(timestamp_ns - first_ns_);
    const bool is_on_time = started_ && due + std::chrono::milliseconds(100) >= now;
    const Clock::time_point latest = now + std::chrono::milliseconds(500);
    if (is_on_time && due <= latest) return due;
    start_ = is_on_time ? latest : now;
    started_ = true;
    first_ns_ = timestamp_ns;
    return start_;
  }

 private:
  bool started_ = false;
  Clock::time_point start_;
  std::int64_t first_ns_ = 0;
};

}  // namespace arthronaut::worker
