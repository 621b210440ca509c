// Directions in the surgeon's words.
#pragma once

#include <Eigen/Core>
#include <string>

#include "planning/bones/bone.h"

namespace arthronaut::plan {

// "21 mm proximal, 14 mm lateral, 3 mm anterior" of a displacement in LPS; parts below half a millimetre are
// left out.
[[nodiscard]] std::string anatomical_text(const Eigen::Vector3d& displacement_mm, bones::Side side);

}  // namespace arthronaut::plan
