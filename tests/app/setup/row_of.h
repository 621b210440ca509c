// Looks a number up in what a display lists.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/setup/station.h"

namespace arthronaut::test {

inline const setup::Row& row_of(const std::vector<setup::Row>& rows, const std::string& name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.name == name; });
  if (found == rows.end()) throw std::runtime_error("no row " + name);
  return *found;
}

}  // namespace arthronaut::test
