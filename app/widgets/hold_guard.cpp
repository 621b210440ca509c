#include "app/widgets/hold_guard.h"

#include <algorithm>
#include <utility>

namespace arthronaut::widgets {

void HoldGuard::press(std::string what) {
  *this = {};
  what_ = std::move(what);
  is_held_ = true;
}

void HoldGuard::let_go() {
  if (is_held_) remind(what_);
}

void HoldGuard::cancel() { *this = {}; }

void HoldGuard::remind(std::string what) {
  *this = {};
  what_ = std::move(what);
  reminds_for_s_ = kReminder_s;
}

bool HoldGuard::advance(double now_s) {
  const double passed = last_s_ < 0 ? 0 : std::max(now_s - last_s_, 0.0);
  last_s_ = now_s;
  if (is_held_) {
    held_s_ += std::min(passed, kMostOfAFrame_s);
    if (held_s_ < kHold_s) return false;
    cancel();
    return true;
  }
  if (what_.empty()) return false;
  reminds_for_s_ -= passed;
  if (reminds_for_s_ <= 0) cancel();
  return false;
}

double HoldGuard::progress() const { return is_held_ ? std::min(held_s_ / kHold_s, 1.0) : 0; }

}  // namespace arthronaut::widgets
