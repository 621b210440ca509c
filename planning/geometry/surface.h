// Exact queries against a triangle mesh: nearest point, rays, inside or outside; and the triangles near a
// line. Built once (triangle_tree.h, normals and their neighbourhoods), then read by any number of threads:
// whoever asks often keeps it for as long as the bone.
#pragma once

#include <array>
#include <limits>
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
  // touches. A ray through an edge or a vertex crosses the surface once there, not once a triangle. The first
  // costs less than all: what lies behind it is not looked at, nor what lies further off than within_mm.
  [[nodiscard]] std::optional<RayHit> first_hit(
      const Eigen::Vector3d& origin_mm, const Eigen::Vector3d& direction,
      double within_mm = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] std::vector<RayHit> all_hits(const Eigen::Vector3d& origin_mm,
                                             const Eigen::Vector3d& direction) const;

  // What all of this is asked of: the mesh given, without its degenerate triangles, with one vertex where
  // several lay in the same place. RayHit::triangle and SurfacePoint::triangle are of the mesh given, not of
  // this one.
  [[nodiscard]] const TriangleMesh& mesh() const;
  // Of a triangle of mesh(), unit: its own, and those of its corners as smooth_normals.h says.
  [[nodiscard]] const Eigen::Vector3d& normal(std::int32_t triangle) const;
  [[nodiscard]] const std::array<Eigen::Vector3d, 3>& smooth_normals(std::int32_t triangle) const;
  // Appends the triangles of mesh() near a segment, as TriangleTree::near_segment does.
  void triangles_near(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm,
                      std::vector<std::int32_t>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace arthronaut::geometry
