// One piece of bone as a solid in its part of the volume, and its shape from slice to slice. Inner header of
// segmentation.
#pragma once

#include <vector>

#include "planning/images/voxel_mask.h"
#include "planning/segmentation/edge_surface.h"

namespace arthronaut::segmentation {

struct BoneSolid {
  Box box;
  images::VoxelMask mask{Eigen::Vector3i::Zero()};

  [[nodiscard]] Eigen::Vector3d lps_of(const images::Volume& volume, std::size_t voxel) const;
};

// The voxels of the volume as a solid: gaps of the shell closed, marrow filled in. Where the bone runs out of
// the volume its marrow is closed off at the border.
[[nodiscard]] BoneSolid solid_of(const images::Volume& volume, const std::vector<std::size_t>& voxels,
                                 double closing_radius_mm);
// The same for a part of a solid.
[[nodiscard]] BoneSolid solid_of(const images::Volume& volume, const Box& box, const images::VoxelMask& part,
                                 double closing_radius_mm);

// Where a piece lies and how tall it is; LPS.
struct PieceExtent {
  Eigen::Vector3d center_mm;
  double height_mm = 0, low_mm = 0;
};
[[nodiscard]] PieceExtent extent_of(const std::vector<Eigen::Vector3d>& points_mm);  // at least one

// Of the box of the one solid what lies in the other one; nothing without another (null).
[[nodiscard]] images::VoxelMask within_other(const BoneSolid& solid, const BoneSolid* other);

// Cross-sections at right angles to the patient's up, 2 mm thick or a slice.
struct SectionProfile {
  double low_mm = 0, step_mm = 2;  // LPS z of the first section's lower side
  std::vector<double> area_mm2;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // of the solid
  double volume_mm3 = 0;

  [[nodiscard]] double high_mm() const { return low_mm + step_mm * static_cast<double>(area_mm2.size()); }
  [[nodiscard]] double largest_mm2() const;
  // Height of the middle of the largest section.
  [[nodiscard]] double largest_at_mm() const;
};
[[nodiscard]] SectionProfile profile_of(const images::Volume& volume, const BoneSolid& solid);

// Takes away what hangs on the bone by a neck and is much smaller: the fibula, the patella. `marrow`, of the
// solid's box, was added to the bone and is no part of a neck. Returns the part that was taken away, empty
// when there was none.
[[nodiscard]] std::vector<Eigen::Vector3d> take_off_appendage(const images::Volume& volume, BoneSolid& solid,
                                                              const images::VoxelMask& marrow);

}  // namespace arthronaut::segmentation
