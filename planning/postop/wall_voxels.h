// The voxels about a bore that tell of its wall. Inner header of postop.
#pragma once

#include <unordered_map>
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
  bool is_metal, is_by_metal;  // denser than bone; or within 1 mm of what is
  float depth_mm = kDeep_mm;   // under the bone's surface, at most kDeep_mm; out: negative
  Eigen::Vector3f deeper = Eigen::Vector3f::Zero();  // unit, from the surface on; zero where it is deep
};

// How deep voxels of one volume lie under the bone's surface. Bores that are tried one after another share
// most of theirs, and the nearest point of a surface is dear: each is sought once.
class VoxelDepths {
 public:
  // The bone must outlive it.
  explicit VoxelDepths(const geometry::Surface& bone) : bone_(bone) {}

  // Depth and direction of a voxel; `index`: its place in the volume.
  void tell(std::size_t index, WallVoxel& voxel);

 private:
  struct Depth {
    float depth_mm;
    Eigen::Vector3f deeper;
  };

  const geometry::Surface& bone_;
  std::unordered_map<std::size_t, Depth> known_;
};

// The voxels 0.9 mm or more within the bone and within `reach_mm` of the bore's axis; 0.3 mm where the
// surface above lies within 37 deg of square to that. `depths`: of the bone that `grid` is of.
[[nodiscard]] std::vector<WallVoxel> wall_voxels(const images::Volume& postop,
                                                 const geometry::RigidTransform& plan_from_postop,
                                                 const BoneGrid& grid, VoxelDepths& depths, const Bore& bore,
                                                 double length_mm, double reach_mm);

}  // namespace arthronaut::postop
