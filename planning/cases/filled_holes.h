// Where a bone's surface was open when it was made, and was closed: there nobody has seen bone.
#pragma once

#include <string>
#include <vector>

#include "planning/bones/mesh_repair.h"

namespace arthronaut::cases {

struct FilledHoles {
  std::vector<bones::FilledHole> holes;  // one at least

  // "a hole of its surface about 12 mm across, at 1, 2, 3 mm, was filled in: ...": of the widest.
  [[nodiscard]] std::string words() const;
  bool operator==(const FilledHoles&) const = default;
};

}  // namespace arthronaut::cases
