#include "planning/postop/bone_grid.h"

#include <algorithm>

#include "planning/images/voxel_mask.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kSoft_hu = -100, kHard_hu = 800;
constexpr double kRoom_mm = 6;

images::VoxelMask inside_of(const geometry::Surface& bone, const BoneGrid& grid) {
  images::VoxelMask inside(grid.size);
  for (int j = 0; j < grid.size.y(); ++j) {
    for (int i = 0; i < grid.size.x(); ++i) {
      // A little beside the cells' middles, where no vertex lies by design.
      const Vector3d below =
          grid.first_mm + BoneGrid::kStep_mm * Vector3d(i + 1.3e-5, j + 2.7e-5, -1e4 / BoneGrid::kStep_mm);
      int within = 0;
      double from = 0;
      for (const auto& hit : bone.all_hits(below, Vector3d::UnitZ())) {
        const double z = (hit.distance_mm - 1e4) / BoneGrid::kStep_mm;
        const bool enters = hit.normal.z() < 0;
        if (enters && within++ == 0) from = z;
        if (enters || within == 0 || --within > 0) continue;
        const int last = std::min(grid.size.z() - 1, static_cast<int>(std::floor(z)));
        for (int k = std::max(0, static_cast<int>(std::ceil(from))); k <= last; ++k)
          inside.inside[inside.index(i, j, k)] = 1;
      }
    }
  }
  return inside;
}

// Signed depth; the surface lies half-way between a cell within and one without.
std::vector<float> signed_depths(const images::VoxelMask& inside) {
  const Vector3d spacing = Vector3d::Constant(BoneGrid::kStep_mm);
  images::VoxelMask outside = inside;
  for (auto& cell : outside.inside) cell = cell ? 0 : 1;
  std::vector<float> depth = images::depths_mm(inside, spacing);
  const std::vector<float> out = images::depths_mm(outside, spacing);
  const auto half = static_cast<float>(0.5 * BoneGrid::kStep_mm);
  for (std::size_t c = 0; c < depth.size(); ++c)
    depth[c] = inside.inside[c] ? depth[c] - half : half - out[c];
  return depth;
}

}  // namespace

double BoneGrid::depth_at(const Vector3d& p_mm) const {
  const Vector3d at = (p_mm - first_mm) / kStep_mm;
  if (!(at.array() >= 0).all() || (at.array() >= (size.array() - 1).cast<double>()).any()) return -1e3;
  const Vector3i low = at.cast<int>();
  const Vector3d f = at - low.cast<double>();
  const auto nx = static_cast<std::size_t>(size.x()), plane = nx * static_cast<std::size_t>(size.y());
  const float* const v = depth_mm.data() + static_cast<std::size_t>(low.x()) +
                         nx * static_cast<std::size_t>(low.y()) + plane * static_cast<std::size_t>(low.z());
  const auto line = [&](std::size_t o) { return v[o] + f.x() * (v[o + 1] - v[o]); };
  const auto face = [&](std::size_t o) { return line(o) + f.y() * (line(o + nx) - line(o)); };
  return face(0) + f.z() * (face(plane) - face(0));
}

BoneGrid bone_grid(const images::VolumeSampler& postop, const geometry::RigidTransform& postop_from_plan,
                   const geometry::Surface& bone, const Vector3d& near_mm, double radius_mm) {
  const geometry::Bounds bounds = geometry::bounds_of(bone.mesh());
  const Vector3d low = (bounds.min_mm.array() - kRoom_mm).max(near_mm.array() - radius_mm),
                 high = (bounds.max_mm.array() + kRoom_mm).min(near_mm.array() + radius_mm);
  BoneGrid grid;
  grid.first_mm = low;
  grid.size = ((high - low) / BoneGrid::kStep_mm).array().ceil().max(2).cast<int>();
  const images::VoxelMask inside = inside_of(bone, grid);
  grid.depth_mm = signed_depths(inside);
  grid.grey.assign(grid.depth_mm.size(), static_cast<float>(kSoft_hu));
  images::VoxelMask metal(grid.size);
  constexpr double kQuarter_mm = 0.25 * BoneGrid::kStep_mm;
  std::size_t c = 0;
  for (int k = 0; k < grid.size.z(); ++k) {
    for (int j = 0; j < grid.size.y(); ++j) {
      for (int i = 0; i < grid.size.x(); ++i, ++c) {
        if (grid.depth_mm[c] < -4) continue;
        const Vector3d p = grid.first_mm + BoneGrid::kStep_mm * Vector3d(i, j, k);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const Vector3d off(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
          const double v = postop.at(postop_from_plan * (p + kQuarter_mm * off));
          if (v > kMetal_hu) metal.inside[c] = 1;
          sum += std::isfinite(v) ? std::clamp(v, kSoft_hu, kHard_hu) : kSoft_hu;
        }
        grid.grey[c] = static_cast<float>(sum / 8);
      }
    }
  }
  if (metal.count() > 0) {
    std::vector<std::size_t> cells;
    for (std::size_t m = 0; m < metal.inside.size(); ++m)
      if (metal.inside[m]) cells.push_back(m);
    const auto far = images::distances_mm(grid.size, cells, Vector3d::Constant(BoneGrid::kStep_mm));
    constexpr double kBeside_mm = 1.1 * BoneGrid::kStep_mm;
    for (std::size_t m = 0; m < far.size(); ++m)
      if (far[m] <= kBeside_mm) grid.grey[m] = 0;
  }
  return grid;
}

}  // namespace arthronaut::postop
