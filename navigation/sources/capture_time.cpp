#include "navigation/sources/capture_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace arthronaut::sources {

CaptureTime capture_time(double driver_ms, std::int64_t handed_over_ns) {
  const double age_ms = static_cast<double>(handed_over_ns) * 1e-6 - driver_ms;
  // Written so that NaN is no stamp.
  if (!(driver_ms > 0) || !(age_ms >= 0)) return {.ns = handed_over_ns};
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
    *this = StreamClock();
    has_begun_ = true;
    apart_ns_ = apart_ns;
    first_ns_ = newest_ns_ = stamp_ns;
    quarter_ns_ = arrived_ns;
  } else {
    apart_ns_ = std::min(apart_ns, apart_ns_ + (arrived_ns - at_ns_) * kDrift_ppm / 1'000'000);
    follow_step(stamp_ns, apart_ns);
  }
  constexpr std::int64_t kQuarter_ns = 250'000'000;
  const std::int64_t age_ns = apart_ns - apart_ns_;
  if (arrived_ns - quarter_ns_ > kQuarter_ns) {
    least_age_before_ns_ = std::exchange(least_age_ns_, age_ns);
    quarter_ns_ = arrived_ns;
  }
  least_age_ns_ = std::min(least_age_ns_, age_ns);
  ++count_;
  stamp_ns_ = stamp_ns;
  at_ns_ = arrived_ns;
}

// By stamps alone: when they arrive says nothing on a machine that is behind. Pictures that are put in order
// go back every 17 at the latest, and what went back for once comes to where it was by a jump.
void StreamClock::follow_step(std::int64_t stamp_ns, std::int64_t apart_ns) {
  constexpr std::int64_t kInOrder = 30;
  ++in_order_;
  if (step_ && stamp_ns <= step_->newest_ns) step_.reset();
  if (step_) {
    ++step_->count;
    step_->newest_ns = stamp_ns;
    step_->least_apart_ns = std::min(step_->least_apart_ns, apart_ns);
  } else if (stamp_ns < newest_ns_ && std::exchange(in_order_, 0) > kInOrder) {
    step_ = {newest_ns_, stamp_ns, std::min(least_age_ns_, least_age_before_ns_), stamp_ns, apart_ns};
  }
  if (stamp_ns <= newest_ns_) return;
  newest_ns_ = stamp_ns;
  if (!step_) return;
  // 3 / 2 of the usual way, of all pictures before.
  const std::int64_t way_ns = stamp_ns - step_->to_ns, before_ns = step_->from_ns - first_ns_;
  const bool came_back_stepwise = 2 * way_ns * count_ <= 3 * before_ns * step_->count;
  if (came_back_stepwise) {
    // Whoever was behind still is.
    apart_ns_ = std::max(apart_ns_, step_->least_apart_ns - step_->behind_ns);
    first_ns_ = step_->to_ns;
    count_ = step_->count;
  }
  step_.reset();
}

std::int64_t steady_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace arthronaut::sources
