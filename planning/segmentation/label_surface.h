// The surface of what somebody painted in a CT: the labels say what is bone, the CT where within a voxel its
// edge is.
#pragma once

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::segmentation {

// LPS, mm, closed; not yet turned outwards. What the label takes is bone whatever its grey, and its border
// moves to the local edge by no more than a voxel outwards (edge_surface.h); bone of other labels is kept
// out. Throws InvalidInput when the labels are not of the CT's size or do not hold the label.
[[nodiscard]] geometry::TriangleMesh label_surface_at_edges(const images::Volume& ct,
                                                            const images::Volume& labels, int label);

}  // namespace arthronaut::segmentation
