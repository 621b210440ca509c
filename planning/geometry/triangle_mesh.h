// A triangle mesh as plain data: mm, LPS for bones, triangles counter-clockwise seen from outside.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace arthronaut::geometry {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<std::array<std::int32_t, 3>> triangles;  // indices into vertices_mm

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

struct Bounds {
  Eigen::Vector3d min_mm, max_mm;
  [[nodiscard]] Eigen::Vector3d size_mm() const { return max_mm - min_mm; }
  [[nodiscard]] Eigen::Vector3d center_mm() const { return 0.5 * (min_mm + max_mm); }
};

// Precondition: at least one vertex.
[[nodiscard]] Bounds bounds_of(const TriangleMesh& mesh);
// Unit vertex normals, each the area-weighted mean of its triangles; zero for a vertex without triangles.
[[nodiscard]] std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh);
// Signed volume in mm^3 by the divergence theorem: positive when a closed mesh is oriented outwards.
[[nodiscard]] double signed_volume_mm3(const TriangleMesh& mesh);
[[nodiscard]] double surface_area_mm2(const TriangleMesh& mesh);

}  // namespace arthronaut::geometry
