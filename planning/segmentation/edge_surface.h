// The surface of a bone in a CT, where its edge is.
//
// One threshold for all of a bone finds a thick cortex too large and a thin one too small, as a scanner blurs
// both. Here the value of the edge is taken anew all over the surface, from profiles across it: half-way from
// outside to the peak (the full width at half maximum of e.g. Prevrhal et al. 1999), and further up where the
// cortex is too thin for the blur (cortex_profile.h; not in slices that are thick). The surface runs where
// the volume takes that value: between the voxels, not along them. What is inside is inside whatever its
// grey: the surface is closed by construction and has no holes where the cortex is thin or the marrow dark.
#pragma once

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"
#include "planning/images/voxel_mask.h"

namespace arthronaut::segmentation {

// A part of a volume's grid.
struct Box {
  Eigen::Vector3i first = Eigen::Vector3i::Zero();  // of the volume
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
};

struct EdgeOptions {
  double threshold = 250;  // that the solid was made with; where no edge can be seen it decides
  double reach_mm = 2.5;   // a profile runs so far out and in
  double least_step = 80;  // HU from outside to the cortex below which there is no edge to be seen
};

// The bone as a solid, marrow included, in the box of the volume: its mask has the box's size. `others`: of
// the same size, set where another bone is; it is kept out. Solid and volume touch the border only where the
// bone is cut off there, which is closed with a flat cap.
[[nodiscard]] geometry::TriangleMesh edge_surface(const images::Volume& volume, const Box& box,
                                                  const images::VoxelMask& solid,
                                                  const images::VoxelMask& others,
                                                  const EdgeOptions& options = {});

}  // namespace arthronaut::segmentation
