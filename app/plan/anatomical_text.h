// Directions in the surgeon's words.
#pragma once

#include <Eigen/Core>
#include <string>

#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::plan {

// "21 mm proximal, 14 mm lateral, 3 mm anterior" of a displacement in the bone's frame, along the bone's
// axes; parts below half a millimetre are left out, and nothing is said where all are.
[[nodiscard]] std::string anatomical_text(const Eigen::Vector3d& displacement_mm,
                                          const landmarks::AnatomicalAxes& axes);
// "21 mm proximal, 14 mm lateral of the entry", or "at the entry".
[[nodiscard]] std::string place_from_entry(const Eigen::Vector3d& displacement_mm,
                                           const landmarks::AnatomicalAxes& axes);

}  // namespace arthronaut::plan
