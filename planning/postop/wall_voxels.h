// The voxels about a bore that tell of its wall. Inner header of postop.
#pragma once

#include <vector>

#include "planning/postop/bone_grid.h"
#include "planning/postop/tunnel_search.h"

namespace arthronaut::postop {

// Under the bone's surface; what lies deeper is marrow, wherever it lies.
inline constexpr double kDeep_mm = 4;

// A voxel of the images within the bone and near the bore.
struct WallVoxel {
  Eigen::Vector3d p_mm;  // in the plan's frame
  float hu;
  bool is_metal, is_by_metal;                        // denser than bone; or within 1 mm of what is
  float depth_mm = kDeep_mm;                         // under the bone's surface, at most kDeep_mm
  Eigen::Vector3f deeper = Eigen::Vector3f::Zero();  // unit, from the surface on; zero where it is deep
};

// The voxels within the bone within `reach_mm` of the bore's axis. `bone`: what `grid` is of.
[[nodiscard]] std::vector<WallVoxel> wall_voxels(const images::Volume& postop,
                                                 const geometry::RigidTransform& plan_from_postop,
                                                 const BoneGrid& grid, const geometry::Surface& bone,
                                                 const Bore& bore, double length_mm, double reach_mm);

}  // namespace arthronaut::postop
