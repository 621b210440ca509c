#include "navigation/sources/lost_pictures.h"

#include <utility>

namespace arthronaut::sources {

namespace {

// Long enough to count by, and to be read.
constexpr std::int64_t kCounted_ns = 2'000'000'000;
constexpr long kTold_percent = 5;
// More than a minute at 60 a second is no loss, but a driver that counts in its own way.
constexpr std::uint32_t kMostLost = 3600;

}  // namespace

std::int64_t LostPictures::came(std::uint32_t sequence, bool is_damaged, std::int64_t now_ns) {
  if (!last_) begun_ns_ = now_ns;
  // Unsigned: a count that begins anew after 2^32 is none.
  const std::uint32_t step = last_ ? sequence - *last_ : 1;
  last_ = sequence;
  const long missing = step >= 1 && step <= kMostLost ? static_cast<long>(step) - 1 : 0;
  lost_ += missing + (is_damaged ? 1 : 0);
  all_ += missing + 1;
  if (now_ns - begun_ns_ >= kCounted_ns) {
    const long lost = lost_ - lost_before_, all = all_ - all_before_;
    words_ = 100 * lost > kTold_percent * all
                 ? std::to_string(lost) + " of the last " + std::to_string(all) + " pictures were lost"
                 : "";
    begun_ns_ = now_ns;
    lost_before_ = lost_;
    all_before_ = all_;
  }
  // A damaged picture is given to nobody: it is missing before the next one.
  not_told_ += missing + (is_damaged ? 1 : 0);
  return is_damaged ? 0 : std::exchange(not_told_, 0);
}

}  // namespace arthronaut::sources
