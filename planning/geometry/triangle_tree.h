// Which triangles of a mesh lie near a line: a tree of boxes, built once, then read by any number of threads.
// Nearest points and rays with exact predicates are Surface's; this one collects.
#pragma once

#include <cstdint>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

class TriangleTree {
 public:
  // The mesh must outlive it. Indices of triangles must be those of vertices; an empty mesh gives an empty
  // tree.
  explicit TriangleTree(const TriangleMesh& mesh);

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
  std::vector<Bounds> bounds_;  // in the order of triangles_
};

}  // namespace arthronaut::geometry
