// Where the images end within a bone. Inner header of import.
#pragma once

#include <vector>

#include "planning/bones/bone.h"
#include "planning/bones/image_cut.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::importing {

// On which sides the bone, whose mesh was made of the volume, is cut off flat by the edge of
// the images, and how large each cut is; none when it is whole. Through the shaft (a femur above, a tibia
// below) every knee scan cuts, and nothing is said. Anywhere else bone is missing that landmarks, grids and
// checks are taken to follow from. Cuts below 10 mm2, a few voxels of a rounded rim, count as none.
[[nodiscard]] std::vector<bones::ImageCut> cuts_of(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                                   const images::Volume& volume);

}  // namespace arthronaut::importing
