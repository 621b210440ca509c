#include "planning/postop/narrowing.h"

#include <algorithm>
#include <vector>

#include "planning/geometry/quantile.h"

namespace arthronaut::postop {

namespace {

// Of a stretch whose width tells.
constexpr double kSeen = 0.5, kMostSigma_mm = 0.3;
constexpr std::size_t kLeastBefore = 2;
// Of the drop over one stretch, that its neighbours to either side may differ by.
constexpr double kMostTaper = 1.0 / 3;

bool is_known(const Stretch& stretch) {
  return stretch.seen_share > kSeen && stretch.noise_sigma_mm < kMostSigma_mm;
}

std::vector<double> known_widths(std::span<const Stretch> stretches) {
  std::vector<double> widths;
  for (const Stretch& stretch : stretches)
    if (is_known(stretch)) widths.push_back(stretch.diameter_mm);
  return widths;
}

// Whether the bore is even to either side of a drop from the last stretch but one before `first` to that.
bool is_at_once(std::span<const Stretch> stretches, std::size_t first) {
  const auto fall = [&](std::size_t from, std::size_t to) {
    return to < stretches.size() && is_known(stretches[from]) && is_known(stretches[to])
               ? stretches[from].diameter_mm - stretches[to].diameter_mm
               : 0.0;
  };
  const double drop_mm = fall(first - 2, first),
               before_mm = first > kLeastBefore ? fall(first - 3, first - 2) : fall(0, 1),
               after_mm = fall(first, first + 1);
  return drop_mm == 0 || std::max(before_mm, after_mm) <= kMostTaper * drop_mm;
}

}  // namespace

std::optional<Narrowing> narrowing_of(std::span<const Stretch> stretches) {
  for (std::size_t first = kLeastBefore; first < stretches.size(); ++first) {
    // The last one before may hold both widths.
    std::vector<double> before = known_widths(stretches.first(first - 1)),
                        after = known_widths(stretches.subspan(first));
    if (is_known(stretches[first - 1]) && before.size() < kLeastBefore)
      before.push_back(stretches[first - 1].diameter_mm);
    if (before.size() < kLeastBefore || after.empty()) continue;
    const double narrowest_before_mm = *std::ranges::min_element(before),
                 wide_mm = geometry::median(std::move(before));
    if (*std::ranges::max_element(after) > narrowest_before_mm - 2 * kThinner_mm) continue;
    if (!is_at_once(stretches, first)) continue;
    const double thin_mm = *std::ranges::min_element(after);
    const auto wide_share = [&](const Stretch& stretch, double otherwise) {
      if (!is_known(stretch)) return otherwise;
      return std::clamp((stretch.diameter_mm - thin_mm) / (wide_mm - thin_mm), 0.0, 1.0);
    };
    const double length_mm = stretches[1].from_entry_mm - stretches[0].from_entry_mm;
    return Narrowing{stretches[first].from_entry_mm + length_mm * (wide_share(stretches[first - 1], 1) +
                                                                   wide_share(stretches[first], 0) - 1.5),
                     thin_mm};
  }
  return std::nullopt;
}

}  // namespace arthronaut::postop
