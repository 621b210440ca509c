// What is done to a tunnel and its CT before the benchmark looks at it.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include "tests/planning/postop/postop_ct.h"

namespace arthronaut::test {

struct DrilledKind {
  const char* name;
  std::function<void(Drilled&, KnownCtOptions&, std::mt19937_64&)> change;
  // So far off the plan, each way; so wide, least and most.
  double most_off_mm = 5, most_tilt_deg = 10, least_diameter_mm = 7, most_diameter_mm = 10;
};

// Those named "varied ..." draw slices, kernel, noise, cortex, marrow, grain and graft besides; no limit of
// the product was set by them.
[[nodiscard]] const std::vector<DrilledKind>& drilled_kinds();

}  // namespace arthronaut::test
