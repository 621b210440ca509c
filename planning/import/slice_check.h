// Whether the slices of images lie too far apart for the surfaces made of them. Inner header of import.
#pragma once

#include <string>

#include "planning/images/volume.h"

namespace arthronaut::importing {

// A doubt of every bone whose slices lie more than 1.6 mm apart; empty else. What was measured stands in
// docs/benchmarks.md; of CTs: 95 % of a tibia's surface about the entry lie within 0.4 mm at 1.25 mm,
// 0.7 at 1.5, 1.1 at 2, 1.8 at 3 and 4.8 mm at 4: from 2 mm on it leaves a millimetre.
[[nodiscard]] std::string slice_doubt(const images::Volume& images);

}  // namespace arthronaut::importing
