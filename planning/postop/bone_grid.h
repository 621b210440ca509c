// What the images show within a bone of the plan, in cells of the plan's frame, and how deep in the bone each
// cell lies. Inner header of postop.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/images/volume_sampler.h"

namespace arthronaut::postop {

// Denser than any bone: screws, buttons, staples.
inline constexpr double kMetal_hu = 2200;

struct BoneGrid {
  static constexpr double kStep_mm = 0.75;

  Eigen::Vector3d first_mm = Eigen::Vector3d::Zero();  // middle of the first cell
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<float> depth_mm;  // below the bone's surface, negative outside; i runs fastest
  // HU, held between soft tissue and hard cortex; metal and what is beside it count as soft: no bone.
  std::vector<float> grey;

  // A place counted in cells from the corner of the first one.
  [[nodiscard]] Eigen::Vector3d in_cells(const Eigen::Vector3d& p_mm) const {
    return (p_mm - first_mm) / kStep_mm + Eigen::Vector3d::Constant(0.5);
  }
  // The cell that such a place lies in; -1 beyond the grid.
  [[nodiscard]] std::ptrdiff_t cell_at(const Eigen::Vector3d& at) const {
    if (!(at.array() >= 0).all() || (at.array() >= size.cast<double>().array()).any()) return -1;
    return static_cast<std::ptrdiff_t>(at.x()) +
           static_cast<std::ptrdiff_t>(size.x()) *
               (static_cast<std::ptrdiff_t>(at.y()) +
                static_cast<std::ptrdiff_t>(size.y()) * static_cast<std::ptrdiff_t>(at.z()));
  }
  // Trilinear; far outside beyond the grid.
  [[nodiscard]] double depth_at(const Eigen::Vector3d& p_mm) const;
};

// Of the part of the bone within `radius_mm` of a place in the plan's frame.
[[nodiscard]] BoneGrid bone_grid(const images::VolumeSampler& postop,
                                 const geometry::RigidTransform& postop_from_plan,
                                 const geometry::Surface& bone, const Eigen::Vector3d& near_mm,
                                 double radius_mm);

}  // namespace arthronaut::postop
