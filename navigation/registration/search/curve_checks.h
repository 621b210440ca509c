// What can be said against touched curves before any pose is looked for.
#pragma once

#include <string>
#include <vector>

#include "navigation/strokes/curves.h"

namespace arthronaut::registration {

struct CurveCheckOptions {
  std::size_t min_point_count = 30;
  double min_extent_mm = 9;     // of the touched area; smaller ones hold no bone
  double min_breadth_mm = 1.5;  // root mean square, across the straight line that fits best
};

// In plain words; empty when there is nothing. bone_size_mm: the diagonal of the bone's box.
[[nodiscard]] std::vector<std::string> objections_to(const strokes::Curves& curves, double bone_size_mm,
                                                     const CurveCheckOptions& options = {});

}  // namespace arthronaut::registration
