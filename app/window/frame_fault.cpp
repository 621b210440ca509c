#include "app/window/frame_fault.h"

#include "planning/log/log.h"

namespace arthronaut::window {

namespace {

constexpr double kSaid_s = 10;  // long enough to be read

}  // namespace

void FrameFault::note(const std::string& what, double now_s) {
  if (what != what_ || words(now_s).empty()) log::error("a frame was broken off: " + what);
  what_ = what;
  noted_at_s_ = now_s;
}

std::string FrameFault::words(double now_s) const {
  return now_s - noted_at_s_ < kSaid_s ? "Not done: " + what_ : std::string();
}

}  // namespace arthronaut::window
