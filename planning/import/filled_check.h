// Whether a part of a bone's surface was made up to close it. Inner header of import.
#pragma once

#include <vector>

#include "planning/bones/bone.h"
#include "planning/bones/mesh_repair.h"

namespace arthronaut::importing {

// mesh: the mended one. Of the holes that were filled those that are wider than 8 mm: across one a bone as
// round as a condyle (16 mm) is off by 0.5 mm, and one that is hollow there, as in the notch, by more. The
// cut end of a shaft (a femur's above, a tibia's below) is no hole: there every scan ends.
[[nodiscard]] std::vector<bones::FilledHole> wide_holes(std::vector<bones::FilledHole> filled,
                                                        const geometry::TriangleMesh& mesh,
                                                        bones::BoneKind kind);

}  // namespace arthronaut::importing
