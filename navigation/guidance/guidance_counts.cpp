#include "navigation/guidance/guidance_counts.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace arthronaut::guidance {

std::string GuidanceCounts::reasons_of_most() const {
  constexpr std::size_t kMostTold = 2;
  const long all = std::accumulate(counts_.begin(), counts_.end(), 0L), valid = of(GuidanceState::Valid);
  if (2 * valid >= all) return "";
  std::vector<GuidanceState> reasons;
  for (std::size_t i = 0; i < counts_.size(); ++i)
    if (const auto state = static_cast<GuidanceState>(i); state != GuidanceState::Valid && of(state) > 0)
      reasons.push_back(state);
  std::ranges::stable_sort(reasons, std::ranges::greater(),
                           [this](GuidanceState state) { return of(state); });
  std::string words;
  for (std::size_t i = 0; i < std::min(kMostTold, reasons.size()); ++i)
    words +=
        (i > 0 ? ", " : "") + std::string(to_text(reasons[i])) + " (" + std::to_string(of(reasons[i])) + ")";
  return words;
}

}  // namespace arthronaut::guidance
