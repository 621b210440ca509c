// The voxels about a bore that tell of its wall. Inner header of postop.
#pragma once

#include <vector>

#include "planning/postop/bone_grid.h"
#include "planning/postop/tunnel_search.h"

namespace arthronaut::postop {

// A voxel of the images within the bone and near the bore.
struct WallVoxel {
  Eigen::Vector3d p_mm;  // in the plan's frame
  float hu;
  bool is_metal, is_by_metal;  // denser than bone; or within 1 mm of what is
};

// The voxels within the bone within `reach_mm` of the bore's axis.
[[nodiscard]] std::vector<WallVoxel> wall_voxels(const images::Volume& postop,
                                                 const geometry::RigidTransform& plan_from_postop,
                                                 const BoneGrid& grid, const Bore& bore, double length_mm,
                                                 double reach_mm);

}  // namespace arthronaut::postop
