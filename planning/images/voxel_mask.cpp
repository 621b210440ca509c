#include "planning/images/voxel_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace arthronaut::images {

namespace {

// One row of squared distances to the nearest set voxel: the lower envelope of parabolas (Felzenszwalb and
// Huttenlocher, Distance transforms of sampled functions, 2012).
void squared_distances_along(std::vector<double>& f, double spacing, std::vector<double>& result,
                             std::vector<int>& vertex, std::vector<double>& boundary) {
  const int n = static_cast<int>(f.size());
  const double s2 = spacing * spacing;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  int last = -1;
  for (int q = 0; q < n; ++q) {
    if (f[q] == kFar) continue;
    double crossing = -kFar;
    while (last >= 0) {
      const int v = vertex[last];
      crossing = ((f[q] + s2 * q * q) - (f[v] + s2 * v * v)) / (2 * s2 * (q - v));
      if (crossing > boundary[last]) break;
      --last;
      crossing = -kFar;
    }
    ++last;
    vertex[last] = q;
    boundary[last] = crossing;
  }
  if (last < 0) {
    std::fill(result.begin(), result.end(), kFar);
    return;
  }
  for (int q = 0, k = 0; q < n; ++q) {
    while (k < last && boundary[k + 1] < q) ++k;
    const double d = spacing * (q - vertex[k]);
    result[q] = d * d + f[vertex[k]];
  }
}

// In place: 0 where a set voxel is, infinity elsewhere; becomes the squared distance in mm^2.
void to_squared_distances(std::vector<float>& squared, const Eigen::Vector3i& size,
                          const Eigen::Vector3d& spacing_mm) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::size_t step = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(size[axis]);
    std::vector<double> row(n), result(n), boundary(n + 1);
    std::vector<int> vertex(n + 1);
    for (std::size_t block = 0; block < squared.size(); block += step * n) {
      for (std::size_t start = block; start < block + step; ++start) {
        // Most rows of a volume are all near or all far.
        bool has_near = false, has_far = false;
        for (std::size_t i = 0; i < n; ++i) {
          const float f = squared[start + i * step];
          row[i] = f;
          has_near = has_near || f < kFar;
          has_far = has_far || f > 0;
        }
        if (!has_near || !has_far) continue;
        squared_distances_along(row, spacing_mm[axis], result, vertex, boundary);
        for (std::size_t i = 0; i < n; ++i) squared[start + i * step] = static_cast<float>(result[i]);
      }
    }
    step *= n;
  }
}

// Sets every voxel within the radius of one that is `value`, to `value`.
void grow(VoxelMask& mask, std::uint8_t value, const Eigen::Vector3d& spacing_mm, double radius_mm) {
  std::vector<float> squared(mask.inside.size());
  for (std::size_t i = 0; i < squared.size(); ++i) {
    squared[i] = mask.inside[i] == value ? 0.0F : std::numeric_limits<float>::infinity();
  }
  to_squared_distances(squared, mask.size, spacing_mm);
  const auto limit = static_cast<float>(radius_mm * radius_mm);
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (squared[i] <= limit) mask.inside[i] = value;
  }
}

}  // namespace

std::size_t VoxelMask::count() const { return std::accumulate(inside.begin(), inside.end(), std::size_t{0}); }

std::vector<VoxelPiece> connected_pieces(const VoxelMask& mask, std::size_t least_count) {
  std::vector<std::uint8_t> taken(mask.inside.size(), 0);
  std::vector<VoxelPiece> pieces;
  const auto nx = static_cast<std::size_t>(mask.size.x()), ny = static_cast<std::size_t>(mask.size.y());
  for (std::size_t seed = 0; seed < taken.size(); ++seed) {
    if (!mask.inside[seed] || taken[seed]) continue;
    VoxelPiece piece;
    piece.voxels.push_back(seed);
    taken[seed] = 1;
    for (std::size_t at = 0; at < piece.voxels.size(); ++at) {
      for_each_neighbour(mask.size, piece.voxels[at], [&](std::size_t voxel) {
        if (!mask.inside[voxel] || taken[voxel]) return;
        taken[voxel] = 1;
        piece.voxels.push_back(voxel);
      });
    }
    piece.count = piece.voxels.size();
    if (piece.count < least_count) continue;
    for (const std::size_t v : piece.voxels) {
      piece.center_index += Eigen::Vector3d(static_cast<double>(v % nx), static_cast<double>(v / nx % ny),
                                            static_cast<double>(v / (nx * ny)));
    }
    piece.center_index /= static_cast<double>(piece.count);
    pieces.push_back(std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  return pieces;
}

std::vector<float> distances_mm(const Eigen::Vector3i& size, const std::vector<std::size_t>& voxels,
                                const Eigen::Vector3d& spacing_mm) {
  std::vector<float> result(static_cast<std::size_t>(size.cast<std::int64_t>().prod()),
                            std::numeric_limits<float>::infinity());
  for (const std::size_t v : voxels) result[v] = 0;
  to_squared_distances(result, size, spacing_mm);
  for (float& d : result) d = std::sqrt(d);
  return result;
}

std::vector<float> depths_mm(const VoxelMask& mask, const Eigen::Vector3d& spacing_mm) {
  std::vector<float> result(mask.inside.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = mask.inside[i] ? std::numeric_limits<float>::infinity() : 0.0F;
  to_squared_distances(result, mask.size, spacing_mm);
  for (float& d : result) d = std::sqrt(d);
  return result;
}

std::vector<float> signed_depths_mm(const VoxelMask& mask, const Eigen::Vector3d& spacing_mm) {
  VoxelMask outside(mask.size);
  for (std::size_t i = 0; i < mask.inside.size(); ++i) outside.inside[i] = !mask.inside[i];
  std::vector<float> depths = depths_mm(mask, spacing_mm);
  const std::vector<float> away = depths_mm(outside, spacing_mm);
  for (std::size_t i = 0; i < depths.size(); ++i) depths[i] -= away[i];
  return depths;
}

void close_gaps(VoxelMask& mask, const Eigen::Vector3d& spacing_mm, double radius_mm) {
  const VoxelMask before = mask;
  grow(mask, 1, spacing_mm, radius_mm);
  grow(mask, 0, spacing_mm, radius_mm);
  for (std::size_t i = 0; i < mask.inside.size(); ++i) mask.inside[i] |= before.inside[i];
}

void fill_unreached(VoxelMask& mask, unsigned axes) {
  std::vector<std::uint8_t> reached(mask.inside.size(), 0);
  std::vector<std::size_t> front;
  const auto visit = [&](std::size_t voxel) {
    if (mask.inside[voxel] || reached[voxel]) return;
    reached[voxel] = 1;
    front.push_back(voxel);
  };
  for (int k = 0; k < mask.size.z(); ++k) {
    for (int j = 0; j < mask.size.y(); ++j) {
      for (int i = 0; i < mask.size.x(); ++i) {
        const Eigen::Vector3i at(i, j, k);
        for (int axis = 0; axis < 3; ++axis) {
          if ((axes >> axis & 1U) && (at[axis] == 0 || at[axis] == mask.size[axis] - 1))
            visit(mask.index(i, j, k));
        }
      }
    }
  }
  while (!front.empty()) {
    const std::size_t voxel = front.back();
    front.pop_back();
    for_each_neighbour(mask.size, voxel, visit, axes);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) mask.inside[i] = reached[i] ? 0 : 1;
}

void fill_enclosed(VoxelMask& mask, int axis) {
  fill_unreached(mask);
  fill_unreached(mask, 7U & ~(1U << axis));
}

}  // namespace arthronaut::images
