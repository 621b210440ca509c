// Medians and other quantiles of a list.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace arthronaut::geometry {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// The value below which this share of the list lies: the one at rank share * (count - 1), rounded down. Share
// in [0, 1]. `of_none`: that of an empty list.
[[nodiscard]] double quantile(std::vector<double> values, double share, double of_none = kNotKnown);
// The one in the middle; of an even number the upper one.
[[nodiscard]] double median(std::vector<double> values, double of_none = kNotKnown);
// The same without memory of its own, for what is done with every frame. Reorders the values, of which there
// must be one at least.
template <typename Number>
[[nodiscard]] Number median_in_place(std::span<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace arthronaut::geometry
