// How old a message is whose stamp is of another machine's clock. What the two clocks differ by is not known;
// what is known is that nothing arrives before it was stamped. So the smallest difference between arrival and
// stamp that was ever seen stands for a message that took no longer than the network's round trip, and every
// later one is older by what its difference exceeds that. The clocks may be an hour apart.
//
// Pure: one for a connection. A clock that is set back, or stamps that stand still, make all that comes look
// old, never new.
#pragma once

#include <cstdint>

namespace arthronaut::tracker {

class ClockMatch {
 public:
  // longest_transit_s: what the fastest message took at the most, as the round trip bounds it.
  explicit ClockMatch(double longest_transit_s = 0) : longest_transit_s_(longest_transit_s) {}

  void add(double stamp_utc_s, std::int64_t arrival_ns);
  // Enough messages over long enough a time that one of them has come without waiting anywhere.
  [[nodiscard]] bool is_known() const;
  // At the most, as far as the network goes. Precondition: a message was added.
  [[nodiscard]] double age_s(double stamp_utc_s, std::int64_t now_ns) const;

 private:
  double longest_transit_s_;
  double least_delay_s_ = 0;  // smallest arrival - stamp, allowing for how far two clocks run apart
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  long count_ = 0;
};

}  // namespace arthronaut::tracker
