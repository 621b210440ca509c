// From a label map to the surface of one bone.
//
// The surface is taken by marching cubes in the volume's own grid, carried to the patient by the whole affine
// (oblique and sheared grids included) and smoothed there; between thick slices, where the label goes over
// from one to the next (thick_slices.h). Where the bone runs out of the volume it is closed with a flat cap.
#pragma once

#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

struct BoneSurface {
  geometry::TriangleMesh mesh;     // LPS, mm, closed; not yet turned outwards
  std::vector<std::string> notes;  // what was chosen, for a person to see
};

// Throws InvalidInput when the volume is no label map or does not hold the label; the message lists those
// that it does.
[[nodiscard]] BoneSurface surface_of_label(const Volume& volume, int label);

}  // namespace arthronaut::images
