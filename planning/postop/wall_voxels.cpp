#include "planning/postop/wall_voxels.h"

#include <algorithm>

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr double kBesideMetal_mm = 1.5;
// Near the bone's own surface its own edge is in the picture. Where the bore meets that squarely the edge
// lies across the wall, and cortex from nearer to it on tells of the entry.
constexpr double kLeastDepth_mm = 0.9, kLeastSquareDepth_mm = 0.3, kSquare_cos = 0.8;
// By which the grid's depths may be off.
constexpr double kGridOff_mm = BoneGrid::kStep_mm;

}  // namespace

void VoxelDepths::tell(std::size_t index, WallVoxel& voxel) {
  const auto [known, is_new] = known_.try_emplace(index, Depth{voxel.depth_mm, voxel.deeper});
  Depth& depth = known->second;
  if (is_new) {
    const geometry::SurfacePoint nearest = bone_.closest_point(voxel.p_mm);
    const Vector3d from_surface = voxel.p_mm - nearest.point_mm;
    const double depth_mm = from_surface.norm();
    if (from_surface.dot(nearest.normal) > -1e-9)
      depth.depth_mm = static_cast<float>(-depth_mm);
    else if (depth_mm < kDeep_mm)
      depth = {static_cast<float>(depth_mm), (from_surface / depth_mm).cast<float>()};
  }
  voxel.depth_mm = depth.depth_mm;
  voxel.deeper = depth.deeper;
}

std::vector<WallVoxel> wall_voxels(const images::Volume& postop,
                                   const geometry::RigidTransform& plan_from_postop, const BoneGrid& grid,
                                   VoxelDepths& depths, const Bore& bore, double length_mm, double reach_mm) {
  const geometry::RigidTransform postop_from_plan = plan_from_postop.inverse();
  const Eigen::Affine3d index_from_lps = postop.lps_from_index.inverse();
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d u = bore.direction.unitOrthogonal(), v = bore.direction.cross(u);
    const Vector3d p = bore.entry_mm + (corner & 1 ? length_mm + 2 : -2) * bore.direction +
                       (corner & 2 ? reach_mm : -reach_mm) * u + (corner & 4 ? reach_mm : -reach_mm) * v;
    const Vector3d index = index_from_lps * (postop_from_plan * p);
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  const Eigen::Vector3i first = low.array().floor().cast<int>().max(0),
                        last = high.array().ceil().cast<int>().min(postop.size.array() - 1);
  const Eigen::Vector3i beside = (kBesideMetal_mm / postop.spacing_mm().array()).ceil().cast<int>();
  const auto is_by_metal = [&](int i, int j, int k) {
    for (int dk = -beside.z(); dk <= beside.z(); ++dk) {
      for (int dj = -beside.y(); dj <= beside.y(); ++dj) {
        for (int di = -beside.x(); di <= beside.x(); ++di) {
          const Eigen::Vector3i at(i + di, j + dj, k + dk);
          if ((at.array() < 0).any() || (at.array() >= postop.size.array()).any()) continue;
          if (postop.at(at.x(), at.y(), at.z()) > kMetal_hu) return true;
        }
      }
    }
    return false;
  };
  bool has_metal = false;
  for (int k = first.z(); k <= last.z() && !has_metal; ++k)
    for (int j = first.y(); j <= last.y() && !has_metal; ++j)
      for (int i = first.x(); i <= last.x() && !has_metal; ++i) has_metal = postop.at(i, j, k) > kMetal_hu;
  std::vector<WallVoxel> voxels;
  for (int k = first.z(); k <= last.z(); ++k) {
    for (int j = first.y(); j <= last.y(); ++j) {
      for (int i = first.x(); i <= last.x(); ++i) {
        const Vector3d p = plan_from_postop * (postop.lps_from_index * Vector3d(i, j, k));
        const double along = (p - bore.entry_mm).dot(bore.direction);
        if (along < -2 || along > length_mm + 2 ||
            (p - bore.entry_mm - along * bore.direction).norm() > reach_mm)
          continue;
        const double depth_mm = grid.depth_at(p);
        if (depth_mm < kLeastSquareDepth_mm - kGridOff_mm) continue;
        const float hu = postop.at(i, j, k);
        WallVoxel voxel{p, hu, hu > kMetal_hu, false};
        if (depth_mm < kDeep_mm + kGridOff_mm) depths.tell(postop.index(i, j, k), voxel);
        const bool is_square = std::abs(voxel.deeper.cast<double>().dot(bore.direction)) > kSquare_cos;
        if (voxel.depth_mm < (is_square ? kLeastSquareDepth_mm : kLeastDepth_mm)) continue;
        voxel.is_by_metal = has_metal && is_by_metal(i, j, k);
        voxels.push_back(voxel);
      }
    }
  }
  return voxels;
}

}  // namespace arthronaut::postop
