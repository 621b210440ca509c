// A blur by running means, whose time does not grow with its width. Inner header of segmentation.
#pragma once

#include "planning/images/contour.h"

namespace arthronaut::segmentation {

// One running mean along each axis, over the voxels whose centres lie within the radius; beyond the field all
// is zero.
void blur_with_box(images::Field& field, const Eigen::Vector3d& spacing_mm, double radius_mm);

}  // namespace arthronaut::segmentation
