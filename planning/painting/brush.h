// A brush in the patient: a disc in the slice that is looked at, or a ball. Sizes are in mm whatever the
// voxels are.
#pragma once

#include <Eigen/Core>

#include "planning/images/volume.h"
#include "planning/painting/label_change.h"

namespace arthronaut::painting {

struct Brush {
  double radius_mm = 3;
  bool is_ball = false;  // else a disc, one slice thick
};

// What one movement of the brush covers: all within the radius of the line from one place to the other.
struct BrushMove {
  Eigen::Vector3d from_mm = Eigen::Vector3d::Zero(), to_mm = Eigen::Vector3d::Zero();  // LPS
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();                                   // of the slice, unit
  Brush brush;
};

// Gives the voxels the label and notes what changed. A voxel counts by its centre; the one nearest to the
// line's end is painted however small the brush is. A disc takes the voxels that the slice passes through, so
// that what is seen there is painted without holes: in a grid along the slice that is one layer. Nothing
// outside of the volume.
void paint(Labels& labels, const images::Volume& grid, const BrushMove& move, std::uint8_t label,
           LabelChange& change);

}  // namespace arthronaut::painting
