#include "navigation/tracker/clock_match.h"

#include <algorithm>

namespace arthronaut::tracker {

namespace {

constexpr long kFewestMessages = 5;
constexpr double kShortestTime_s = 0.5;
// Quartz clocks run apart by up to 100 millionths.
constexpr double kDrift = 1e-4;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

void ClockMatch::add(double stamp_utc_s, std::int64_t arrival_ns) {
  const double delay_s = seconds(arrival_ns) - stamp_utc_s;
  if (count_ == 0) {
    first_ns_ = arrival_ns;
    least_delay_s_ = delay_s;
  } else {
    least_delay_s_ = std::min(least_delay_s_ + kDrift * seconds(arrival_ns - last_ns_), delay_s);
  }
  last_ns_ = arrival_ns;
  ++count_;
}

bool ClockMatch::is_known() const {
  return count_ >= kFewestMessages && seconds(last_ns_ - first_ns_) >= kShortestTime_s;
}

double ClockMatch::age_s(double stamp_utc_s, std::int64_t now_ns) const {
  return seconds(now_ns) - stamp_utc_s - least_delay_s_ + longest_transit_s_;
}

}  // namespace arthronaut::tracker
