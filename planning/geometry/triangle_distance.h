// The nearest point of a triangle and the sign that goes with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

// Where on a triangle a nearest point lies: a corner, an edge (edge k runs from corner k to corner k + 1) or
// the face.
enum class TrianglePart : std::uint8_t { Corner0, Corner1, Corner2, Edge0, Edge1, Edge2, Face };

struct NearestOnTriangle {
  double squared_mm2 = 0;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  TrianglePart part = TrianglePart::Face;
};

[[nodiscard]] NearestOnTriangle nearest_on_triangle(const Eigen::Vector3d& query_mm,
                                                    const std::array<Eigen::Vector3d, 3>& corners_mm);

// Angle-weighted pseudo-normals (Baerentzen and Aanaes 2005): the sign of (query - nearest) . normal tells
// inside from outside wherever the nearest point of a closed mesh lies. Points of the same place have to
// share an index.
class PseudoNormals {
 public:
  // The mesh must outlive it.
  explicit PseudoNormals(const TriangleMesh& mesh);
  // Of the face unit; of edges and corners of any length.
  [[nodiscard]] const Eigen::Vector3d& at(std::int32_t triangle, TrianglePart part) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> face_, corner_;        // by triangle, by vertex
  std::vector<std::array<Eigen::Vector3d, 3>> edge_;  // by triangle
};

}  // namespace arthronaut::geometry
