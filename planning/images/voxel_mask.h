// Sets of voxels: neighbours, connected pieces, closing, filling. For whoever works voxel by voxel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace arthronaut::images {

struct VoxelMask {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> inside;  // 0 or 1, i runs fastest

  explicit VoxelMask(const Eigen::Vector3i& size_in_voxels)
      : size(size_in_voxels),
        inside(static_cast<std::size_t>(size_in_voxels.cast<std::int64_t>().prod()), 0) {}
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] Eigen::Vector3i index_of(std::size_t voxel) const {  // i, j, k
    const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y());
    return {static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny),
            static_cast<int>(voxel / (nx * ny))};
  }
  [[nodiscard]] std::size_t count() const;
};

// The voxels that share a face with this one, along those axes that have a bit in `axes`: 1, 2 and 4.
template <typename Visit>
void for_each_neighbour(const Eigen::Vector3i& size, std::size_t voxel, const Visit& visit,
                        unsigned axes = 7) {
  const auto nx = static_cast<std::size_t>(size.x()), plane = nx * static_cast<std::size_t>(size.y()),
             count = plane * static_cast<std::size_t>(size.z());
  const std::size_t i = voxel % nx, in_plane = voxel % plane;
  if ((axes & 1U) && i > 0) visit(voxel - 1);
  if ((axes & 1U) && i + 1 < nx) visit(voxel + 1);
  if ((axes & 2U) && in_plane >= nx) visit(voxel - nx);
  if ((axes & 2U) && in_plane + nx < plane) visit(voxel + nx);
  if ((axes & 4U) && voxel >= plane) visit(voxel - plane);
  if ((axes & 4U) && voxel + plane < count) visit(voxel + plane);
}

struct VoxelPiece {
  std::size_t count = 0;
  Eigen::Vector3d center_index = Eigen::Vector3d::Zero();
  std::vector<std::size_t> voxels;
};

// Pieces connected through faces, largest first; those below `least_count` are left out.
[[nodiscard]] std::vector<VoxelPiece> connected_pieces(const VoxelMask& mask, std::size_t least_count);

// Distance of every voxel from the nearest of these, in mm.
[[nodiscard]] std::vector<float> distances_mm(const Eigen::Vector3i& size,
                                              const std::vector<std::size_t>& voxels,
                                              const Eigen::Vector3d& spacing_mm);

// Distance of every set voxel from the nearest unset one, in mm; 0 for those. Beyond the volume nothing is.
[[nodiscard]] std::vector<float> depths_mm(const VoxelMask& mask, const Eigen::Vector3d& spacing_mm);

// The same within; outside negative, minus the distance from the nearest set one. All of a mask without a set
// voxel, or without an unset one, is infinitely deep outside, or inside.
[[nodiscard]] std::vector<float> signed_depths_mm(const VoxelMask& mask, const Eigen::Vector3d& spacing_mm);

// Adds what a ball of this radius cannot enter from outside. Beyond the volume nothing is inside.
void close_gaps(VoxelMask& mask, const Eigen::Vector3d& spacing_mm, double radius_mm);

// Adds what cannot be reached from the border through unset voxels, by steps along those axes alone.
void fill_unreached(VoxelMask& mask, unsigned axes = 7);

// Adds what is enclosed on all sides, and what is enclosed within a slice across `axis` (the marrow of a
// shaft that runs out of the volume).
void fill_enclosed(VoxelMask& mask, int axis);

}  // namespace arthronaut::images
