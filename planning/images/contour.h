// Marching cubes over a part of a volume, carried to the patient. Inner header of images and segmentation.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

// The voxels from the first to the last, both within.
struct VoxelBounds {
  Eigen::Vector3i low = Eigen::Vector3i::Zero(), high = Eigen::Vector3i::Zero();
};
// Of the voxels that hold the label; nullopt where none does.
[[nodiscard]] std::optional<VoxelBounds> bounds_of_label(const Volume& volume, int label);

// A part of a volume with room around it.
struct Field {
  Eigen::Vector3i first_index = Eigen::Vector3i::Zero();  // of the volume, of the field's voxel (0, 0, 0);
                                                          // may be negative
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<float> values;

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k));
  }
};

// Calls visit(field voxel, volume voxel) for the voxels of the field that lie in the volume.
template <typename Visit>
void for_each_shared_voxel(const Field& field, const Eigen::Vector3i& volume_size, const Visit& visit) {
  const Eigen::Vector3i low = field.first_index.cwiseMax(0),
                        high = (field.first_index + field.size).cwiseMin(volume_size);
  for (int k = low.z(); k < high.z(); ++k) {
    for (int j = low.y(); j < high.y(); ++j) {
      std::size_t here =
          field.index(low.x() - field.first_index.x(), j - field.first_index.y(), k - field.first_index.z());
      std::size_t there = static_cast<std::size_t>(low.x()) +
                          static_cast<std::size_t>(volume_size.x()) *
                              (static_cast<std::size_t>(j) +
                               static_cast<std::size_t>(volume_size.y()) * static_cast<std::size_t>(k));
      for (int i = low.x(); i < high.x(); ++i) visit(here++, there++);
    }
  }
}

// How a surface of marching cubes is smoothed (Taubin, Zhang and Golub 1996, windowed sinc): its noise goes,
// its volume stays. 0 iterations: not at all.
struct Smoothing {
  int iterations = 20;
  double pass_band = 0.08;
};

// The surface where the field is `level`, larger values inside. Closed where the field's border is below.
[[nodiscard]] geometry::TriangleMesh contour(const Field& field, float level,
                                             const Eigen::Affine3d& lps_from_index,
                                             const Smoothing& smoothing = {});

}  // namespace arthronaut::images
