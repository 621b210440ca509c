// Which voxels tell of a bore's wall, in a bone that is a cube.
#include "planning/postop/wall_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace arthronaut::postop {
namespace {

using Eigen::Vector3d;

constexpr double kHalf_mm = 20, kVoxel_mm = 0.5;

geometry::TriangleMesh cube() {
  geometry::TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices_mm.emplace_back(c & 1 ? kHalf_mm : -kHalf_mm, c & 2 ? kHalf_mm : -kHalf_mm,
                                  c & 4 ? kHalf_mm : -kHalf_mm);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

images::Volume even_volume() {
  images::Volume volume;
  volume.size = Eigen::Vector3i::Constant(96);
  volume.lps_from_index.linear() = Vector3d::Constant(kVoxel_mm).asDiagonal();
  volume.lps_from_index.translation() = Vector3d::Constant(-23.9);
  volume.values.assign(96UL * 96 * 96, 200);
  return volume;
}

// Those about a bore that enters in the middle of the upper face, so far off square to it.
std::vector<WallVoxel> voxels_of(double slant_rad) {
  const geometry::Surface bone(cube());
  const images::Volume volume = even_volume();
  const images::VolumeSampler sampler(volume);
  const BoneGrid grid = bone_grid(sampler, {}, bone, {0, 0, kHalf_mm}, 40);
  VoxelDepths depths(bone);
  return wall_voxels(volume, {}, grid, depths,
                     {{0, 0, kHalf_mm}, {std::sin(slant_rad), 0, -std::cos(slant_rad)}, 4, 0}, 15, 8);
}

double least_depth_mm(const std::vector<WallVoxel>& voxels) {
  double least_mm = std::numeric_limits<double>::infinity();
  for (const WallVoxel& voxel : voxels) least_mm = std::min<double>(least_mm, voxel.depth_mm);
  return least_mm;
}

}  // namespace

// Cortex from 0.3 mm under the surface on tells of the entry where the bore meets that squarely; else the
// surface's own edge, 0.9 mm wide, is left out. Nothing from outside of the bone is among them.
TEST(WallVoxels, CortexNearTheSurfaceTellsWhereTheBoreMeetsItSquarely) {
  const auto square = voxels_of(0.3), slanting = voxels_of(1.0);
  ASSERT_FALSE(square.empty());
  ASSERT_FALSE(slanting.empty());
  EXPECT_GE(least_depth_mm(square), 0.3);
  EXPECT_LT(least_depth_mm(square), 0.3 + kVoxel_mm);
  EXPECT_GE(least_depth_mm(slanting), 0.9);
  for (const WallVoxel& voxel : square)
    EXPECT_NEAR(voxel.depth_mm, std::min(kDeep_mm, kHalf_mm - voxel.p_mm.z()), 1e-4);
}

}  // namespace arthronaut::postop
