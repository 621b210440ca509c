// Exact queries against a triangle mesh: nearest point, rays, inside or outside. Built once (a CGAL AABB
// tree), then read by any number of threads.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

struct SurfacePoint {
  Eigen::Vector3d point_mm;
  Eigen::Vector3d normal;  // unit, of the triangle, as the mesh is oriented
  std::int32_t triangle = -1;
};

struct RayHit : SurfacePoint {
  double distance_mm = 0;  // along the unit direction
};

class Surface {
 public:
  // Throws InvalidInput when the mesh is empty. Degenerate triangles are left out of the queries.
  explicit Surface(const TriangleMesh& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  [[nodiscard]] SurfacePoint closest_point(const Eigen::Vector3d& query_mm) const;
  // Distance, negative inside. The sign is right for closed, outward oriented meshes.
  [[nodiscard]] double signed_distance_mm(const Eigen::Vector3d& query_mm) const;
  // direction need not be unit. Hits in order of distance, the origin's own triangle included when it
  // touches. A ray through an edge or a vertex crosses the surface once there, not once a triangle.
  [[nodiscard]] std::optional<RayHit> first_hit(const Eigen::Vector3d& origin_mm,
                                                const Eigen::Vector3d& direction) const;
  [[nodiscard]] std::vector<RayHit> all_hits(const Eigen::Vector3d& origin_mm,
                                             const Eigen::Vector3d& direction) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace arthronaut::geometry
