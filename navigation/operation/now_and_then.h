// What costs more than a frame should is done now and then: twice a second, by the time of the frames.
#pragma once

#include <cstdint>

namespace arthronaut::operation {

class NowAndThen {
 public:
  // At the first frame, at one of half a second after the last that it was time at, and at one of before
  // that: another source has another clock.
  [[nodiscard]] bool is_time(std::int64_t now_ns) {
    if (now_ns >= last_ns_ && now_ns - last_ns_ < kBetween_ns) return false;
    last_ns_ = now_ns;
    return true;
  }

 private:
  static constexpr std::int64_t kBetween_ns = 500'000'000;
  std::int64_t last_ns_ = 0;
};

}  // namespace arthronaut::operation
