// The triangle mesh of an implicit surface. Inner header of the phantom.
#pragma once

#include <functional>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::phantom {

// Negative inside, and no further from zero than twice the distance from the surface; its gradient must not
// vanish on the surface.
using ImplicitFunction = std::function<double(const Eigen::Vector3d&)>;

struct ImplicitMeshOptions {
  Eigen::Vector3d min_mm, max_mm;  // the surface lies wholly inside
  double edge_length_mm = 1.0;     // of the sampling grid, about the mesh's mean edge
  int relaxations = 4;             // rounds that even out the triangles along the surface
};

// Closed, outward, vertices on the surface within 1e-6 mm; the same input gives the same mesh, bit for bit.
[[nodiscard]] geometry::TriangleMesh mesh_of(const ImplicitFunction& function,
                                             const ImplicitMeshOptions& options);

// The point of the surface that Newton steps along the gradient reach; at most a few mm away for a good
// result.
[[nodiscard]] Eigen::Vector3d project_onto(const ImplicitFunction& function, const Eigen::Vector3d& p);

}  // namespace arthronaut::phantom
