// A label between slices that lie far apart, as most MRs of knees have them: 3 to 4 mm across, half a
// millimetre within. Inner header of images.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "planning/images/contour.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

// The axis of the grid across which the slices are thick: at least twice as far apart as voxels within them.
[[nodiscard]] std::optional<int> axis_of_thick_slices(const Volume& volume);

// How deep a place lies within a label, in mm, negative outside of it, in a grid that is as fine between the
// slices as, nearly, within them. Distances within each slice go over from one to the next by cubics (Raya
// and Udupa 1990, shape-based interpolation; Catmull and Rom 1974): the border moves evenly, where marching
// cubes of the label itself would leave steps as high as a slice. A shape that ends between two slices ends
// half way, and one that leaves the volume half a slice beyond its last, flat.
struct LabelDepths {
  Field field;  // its border is outside
  Eigen::Affine3d lps_from_index = Eigen::Affine3d::Identity();
};
// Preconditions: the volume holds the label; `axis` is 0, 1 or 2.
[[nodiscard]] LabelDepths depths_between_slices(const Volume& volume, int label, int axis);

}  // namespace arthronaut::images
