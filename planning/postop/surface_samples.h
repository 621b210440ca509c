// Points spread evenly over the part of a surface that is near a place. Inner header of postop.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::postop {

struct SurfaceSample {
  Eigen::Vector3d point_mm;
  Eigen::Vector3d normal;  // unit, outward
};

// In an order in which every beginning is spread evenly, too; the same for the same mesh. Empty when nothing
// of the surface is so near.
[[nodiscard]] std::vector<SurfaceSample> surface_samples(const geometry::TriangleMesh& mesh,
                                                         const Eigen::Vector3d& near_mm, double radius_mm,
                                                         std::size_t count);

}  // namespace arthronaut::postop
