// Where the images end within a bone. Inner header of import.
#pragma once

#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::importing {

// For a person: on which sides the bone, whose mesh was made of the volume, is cut off flat by the edge of
// the images, and how large the cut is; empty when it is whole. Through the shaft (a femur above, a tibia
// below) every knee scan cuts, and nothing is said. Anywhere else bone is missing that landmarks, grids and
// checks are taken to follow from. A cut below 1 cm2 may be the edge of a bone that only just touches it.
[[nodiscard]] std::vector<std::string> cut_doubts(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                                  const images::Volume& volume);

}  // namespace arthronaut::importing
