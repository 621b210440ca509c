// Volumes and labels of known shapes for the tests of painting.
#pragma once

#include "planning/images/volume.h"
#include "planning/painting/label_change.h"

namespace arthronaut::test {

// Voxels of these sizes, the first one's centre at `origin_mm`.
inline images::Volume empty_volume(const Eigen::Vector3i& size, const Eigen::Vector3d& spacing_mm,
                                   const Eigen::Vector3d& origin_mm = Eigen::Vector3d::Zero()) {
  images::Volume volume;
  volume.size = size;
  volume.lps_from_index.linear() = spacing_mm.asDiagonal();
  volume.lps_from_index.translation() = origin_mm;
  volume.values.assign(static_cast<std::size_t>(size.cast<std::int64_t>().prod()), 0.0F);
  return volume;
}

template <typename Visit>
void for_each_voxel(const images::Volume& volume, const Visit& visit) {  // visit(voxel, LPS of its centre)
  std::size_t v = 0;
  for (int k = 0; k < volume.size.z(); ++k)
    for (int j = 0; j < volume.size.y(); ++j)
      for (int i = 0; i < volume.size.x(); ++i)
        visit(v++, Eigen::Vector3d(volume.lps_from_index * Eigen::Vector3d(i, j, k)));
}

// The label in what lies within the radius.
inline void add_ball(painting::Labels& labels, const images::Volume& volume, const Eigen::Vector3d& center_mm,
                     double radius_mm, std::uint8_t label) {
  for_each_voxel(volume, [&](std::size_t v, const Eigen::Vector3d& p) {
    if ((p - center_mm).norm() <= radius_mm) labels[v] = label;
  });
}

}  // namespace arthronaut::test
