#include "app/widgets/slow_screen.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::widgets {

void SlowScreen::drawn(double frame_s, bool matters) {
  if (!matters) {
    count_ = 0;
    slow_s_ = 0;
    return;
  }
  took_s_[count_++ % kFrames] = frame_s;
  if (count_ < kFrames) return;
  std::array<double, kFrames> sorted = took_s_;
  const auto middle = sorted.begin() + kFrames / 2;
  std::nth_element(sorted.begin(), middle, sorted.end());
  const bool is_slow = *middle > (slow_s_ > 0 ? kQuick_s : kSlow_s);
  slow_s_ = is_slow ? *middle : 0;
}

std::string SlowScreen::words() const {
  if (slow_s_ <= 0) return "";
  return "The screen is slow: " + std::to_string(std::lround(std::floor(1 / slow_s_))) +
         " pictures a second. End other programs";
}

}  // namespace arthronaut::widgets
