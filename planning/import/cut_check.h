// Where the images end within a bone. Inner header of import.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::importing {

struct ImageCut {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();  // unit, LPS, out of the images
  double area_mm2 = 0;
};
// On which sides the bone, whose mesh was made of the volume, is cut off flat by the edge of
// the images, and how large each cut is; none when it is whole. Through the shaft (a femur above, a tibia
// below) every knee scan cuts, and nothing is said. Anywhere else bone is missing that landmarks, grids and
// checks are taken to follow from. A cut below 1 cm2 may be the edge of a bone that only just touches it.
[[nodiscard]] std::vector<ImageCut> cuts_of(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                            const images::Volume& volume);
// The same for a person.
[[nodiscard]] std::string cut_doubt(const ImageCut& cut);

}  // namespace arthronaut::importing
