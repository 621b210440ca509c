// A place in three cells of a table of poses or curves. Inner header of strokes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "planning/files/csv_table.h"

namespace arthronaut::strokes {

// In mm. Throws InvalidInput (file, line, column) for what is no number, and, with the reason `too_far`, for
// a cell further from nought than farthest_mm.
[[nodiscard]] inline Eigen::Vector3d place_in(const files::CsvTable& table, std::size_t row,
                                              const std::array<const char*, 3>& columns, double farthest_mm,
                                              const char* too_far) {
  Eigen::Vector3d place_mm;
  for (int i = 0; i < 3; ++i) {
    place_mm[i] = table.number(row, columns[i]);
    if (std::abs(place_mm[i]) > farthest_mm) table.fail(row, columns[i], too_far);
  }
  return place_mm;
}

}  // namespace arthronaut::strokes
