// Which triangle of a mesh is the nearest to a point, and which lie near a line: a tree of boxes, built once,
// then read by any number of threads. Signs, normals and rays with exact predicates are Surface's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "planning/geometry/triangle_distance.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

class TriangleTree {
 public:
  // Indices of triangles must be those of vertices; an empty mesh gives an empty tree. Holds what it needs of
  // the mesh.
  explicit TriangleTree(const TriangleMesh& mesh);

  struct Nearest {
    NearestOnTriangle nearest;
    std::int32_t triangle = -1;
  };
  // Of several triangles that are equally near the first one. Precondition: the tree is not empty.
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& query_mm) const;

  // Appends to `found` every triangle that comes within `radius_mm` of the segment, and some that come a
  // little less near (what is tested is the box of a triangle, widened); each once, in no order.
  void near_segment(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm,
                    std::vector<std::int32_t>& found) const;

 private:
  struct Node {
    Eigen::Vector3d min_mm, max_mm;
    std::int32_t begin = 0, end = 0;  // of triangles_: a leaf's
    std::int32_t further = 0;         // the second child; the first follows its parent. 0: a leaf
  };
  std::int32_t build(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& middles,
                     std::int32_t begin, std::int32_t end);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> triangles_;
  std::vector<Bounds> bounds_;                           // in the order of triangles_
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  // likewise: a leaf's lie side by side
};

}  // namespace arthronaut::geometry
