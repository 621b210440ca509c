#include "planning/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace arthronaut::geometry {

namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeaf = 8;

Bounds bounds_of(const TriangleMesh& mesh, std::int32_t triangle) {
  const auto& corners = mesh.triangles[static_cast<std::size_t>(triangle)];
  const auto at = [&](std::size_t k) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(corners[k])];
  };
  return {at(0).cwiseMin(at(1)).cwiseMin(at(2)), at(0).cwiseMax(at(1)).cwiseMax(at(2))};
}

// A segment, made ready to be held against many boxes.
struct Segment {
  Vector3d from, inverse = Vector3d::Zero();  // one through its length along each axis
  std::array<bool, 3> stands_still{};         // along this axis
  bool stands_still_anywhere = false;

  Segment(const Vector3d& from_mm, const Vector3d& to_mm) : from(from_mm) {
    for (int axis = 0; axis < 3; ++axis) {
      const double along = to_mm[axis] - from_mm[axis];
      stands_still[static_cast<std::size_t>(axis)] = std::abs(along) < 1e-12;
      stands_still_anywhere |= std::abs(along) < 1e-12;
      if (std::abs(along) >= 1e-12) inverse[axis] = 1 / along;
    }
  }
};

// Whether it meets a box widened by a radius: slab by slab.
bool meets(const Segment& segment, double radius, const Vector3d& min, const Vector3d& max) {
  if (!segment.stands_still_anywhere) {  // nearly all: all three at once
    const Eigen::Array3d a = (min.array() - radius - segment.from.array()) * segment.inverse.array(),
                         b = (max.array() + radius - segment.from.array()) * segment.inverse.array();
    return std::max(0.0, a.min(b).maxCoeff()) <= std::min(1.0, a.max(b).minCoeff());
  }
  double enters = 0, leaves = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = min[axis] - radius - segment.from[axis],
                 high = max[axis] + radius - segment.from[axis];
    if (segment.stands_still[static_cast<std::size_t>(axis)]) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low * segment.inverse[axis], b = high * segment.inverse[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
    if (enters > leaves) return false;
  }
  return true;
}

double squared_to_box_mm2(const Vector3d& query, const Vector3d& min, const Vector3d& max) {
  return (min - query).cwiseMax(query - max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.triangles.size());
  if (count == 0) return;
  std::vector<Vector3d> middles(mesh.triangles.size());
  triangles_.resize(mesh.triangles.size());
  for (std::int32_t t = 0; t < count; ++t) {
    triangles_[static_cast<std::size_t>(t)] = t;
    middles[static_cast<std::size_t>(t)] = bounds_of(mesh, t).center_mm();
  }
  nodes_.reserve(mesh.triangles.size() / 2);
  build(mesh, middles, 0, count);
  bounds_.reserve(mesh.triangles.size());
  corners_.reserve(mesh.triangles.size());
  for (const std::int32_t t : triangles_) {
    bounds_.push_back(bounds_of(mesh, t));
    const auto& c = mesh.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](std::size_t k) { return mesh.vertices_mm[static_cast<std::size_t>(c[k])]; };
    corners_.push_back({at(0), at(1), at(2)});
  }
}

std::int32_t TriangleTree::build(const TriangleMesh& mesh, const std::vector<Vector3d>& middles,
                                 std::int32_t begin, std::int32_t end) {
  const auto index = static_cast<std::int32_t>(nodes_.size());
  Bounds box = bounds_of(mesh, triangles_[static_cast<std::size_t>(begin)]);
  for (std::int32_t i = begin + 1; i < end; ++i) {
    const Bounds other = bounds_of(mesh, triangles_[static_cast<std::size_t>(i)]);
    box = {box.min_mm.cwiseMin(other.min_mm), box.max_mm.cwiseMax(other.max_mm)};
  }
  nodes_.push_back({box.min_mm, box.max_mm, begin, end, 0});
  if (end - begin <= kLeaf) return index;
  Eigen::Index axis = 0;
  box.size_mm().maxCoeff(&axis);
  const std::int32_t half = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + half, triangles_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     return middles[static_cast<std::size_t>(a)][axis] <
                            middles[static_cast<std::size_t>(b)][axis];
                   });
  build(mesh, middles, begin, half);
  nodes_[static_cast<std::size_t>(index)].further = build(mesh, middles, half, end);
  return index;
}

TriangleTree::Nearest TriangleTree::nearest(const Vector3d& query_mm) const {
  struct Open {
    std::int32_t node;
    double squared_mm2;  // to its box
  };
  const auto squared_to = [&](std::int32_t index) {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    return squared_to_box_mm2(query_mm, node.min_mm, node.max_mm);
  };
  // Any to begin with: of a point that is not finite it stays that one.
  Nearest best{nearest_on_triangle(query_mm, corners_.front()), triangles_.front()};
  std::array<Open, 64> open;  // deeper than any tree that halves 2^31 triangles
  std::size_t count = 0;
  open[count++] = {0, squared_to(0)};
  while (count > 0) {
    const Open next = open[--count];
    if (next.squared_mm2 > best.nearest.squared_mm2) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.further > 0) {  // the nearer child first: it leaves less of the other one to be looked at
      Open near{next.node + 1, squared_to(next.node + 1)}, far{node.further, squared_to(node.further)};
      if (far.squared_mm2 < near.squared_mm2) std::swap(near, far);
      if (far.squared_mm2 <= best.nearest.squared_mm2) open[count++] = far;
      open[count++] = near;
      continue;
    }
    for (auto i = static_cast<std::size_t>(node.begin); i < static_cast<std::size_t>(node.end); ++i) {
      if (squared_to_box_mm2(query_mm, bounds_[i].min_mm, bounds_[i].max_mm) > best.nearest.squared_mm2)
        continue;
      const NearestOnTriangle found = nearest_on_triangle(query_mm, corners_[i]);
      if (found.squared_mm2 < best.nearest.squared_mm2 ||
          (found.squared_mm2 == best.nearest.squared_mm2 && triangles_[i] < best.triangle))
        best = {found, triangles_[i]};
    }
  }
  return best;
}

void TriangleTree::near_segment(const Vector3d& from_mm, const Vector3d& to_mm, double radius_mm,
                                std::vector<std::int32_t>& found) const {
  if (nodes_.empty()) return;
  const Segment segment(from_mm, to_mm);
  std::array<std::int32_t, 64> open{};  // deeper than any tree that halves 2^31 triangles
  std::size_t count = 1;
  while (count > 0) {
    const std::int32_t index = open[--count];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!meets(segment, radius_mm, node.min_mm, node.max_mm)) continue;
    if (node.further > 0) {
      open[count++] = node.further;
      open[count++] = index + 1;
      continue;
    }
    for (auto i = static_cast<std::size_t>(node.begin); i < static_cast<std::size_t>(node.end); ++i) {
      if (meets(segment, radius_mm, bounds_[i].min_mm, bounds_[i].max_mm)) found.push_back(triangles_[i]);
    }
  }
}

}  // namespace arthronaut::geometry
