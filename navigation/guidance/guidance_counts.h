// In how many frames of a recording guidance was in which state: for whoever sums it up.
#pragma once

#include <array>
#include <string>

#include "navigation/guidance/guidance.h"

namespace arthronaut::guidance {

class GuidanceCounts {
 public:
  void add(GuidanceState state) { ++counts_[static_cast<std::size_t>(state)]; }
  [[nodiscard]] long of(GuidanceState state) const { return counts_[static_cast<std::size_t>(state)]; }
  // Where more than half of the frames had none, the two commonest reasons: "drill guide not seen (120),
  // world marker not seen (30)"; else empty.
  [[nodiscard]] std::string reasons_of_most() const;

 private:
  std::array<long, static_cast<std::size_t>(kLastGuidanceState) + 1> counts_{};
};

}  // namespace arthronaut::guidance
