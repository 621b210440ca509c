#include "planning/geometry/quantile.h"

#include <algorithm>

namespace arthronaut::geometry {
namespace {

double value_at(std::vector<double>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double quantile(std::vector<double> values, double share, double of_none) {
  if (values.empty()) return of_none;
  return value_at(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

double median(std::vector<double> values, double of_none) {
  return values.empty() ? of_none : value_at(values, values.size() / 2);
}

}  // namespace arthronaut::geometry
