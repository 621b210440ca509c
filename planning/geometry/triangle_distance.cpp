#include "planning/geometry/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::geometry {

namespace {

struct EdgeSide {
  std::uint64_t key;  // both vertices, the smaller first
  std::int32_t triangle;
  std::uint8_t edge;
};

std::uint64_t edge_key(std::int32_t a, std::int32_t b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32 | high;
}

}  // namespace

// By Voronoi region, with barycentric coordinates.
NearestOnTriangle nearest_on_triangle(const Eigen::Vector3d& query_mm,
                                      const std::array<Eigen::Vector3d, 3>& corners_mm) {
  const Eigen::Vector3d &a = corners_mm[0], &b = corners_mm[1], &c = corners_mm[2];
  const auto found = [&](const Eigen::Vector3d& point, TrianglePart part) {
    return NearestOnTriangle{(query_mm - point).squaredNorm(), point, part};
  };
  const Eigen::Vector3d ab = b - a, ac = c - a, aq = query_mm - a;
  const double a1 = ab.dot(aq), a2 = ac.dot(aq);
  if (a1 <= 0 && a2 <= 0) return found(a, TrianglePart::Corner0);
  const Eigen::Vector3d bq = query_mm - b;
  const double b1 = ab.dot(bq), b2 = ac.dot(bq);
  if (b1 >= 0 && b2 <= b1) return found(b, TrianglePart::Corner1);
  const double on_ab = a1 * b2 - b1 * a2;
  if (on_ab <= 0 && a1 >= 0 && b1 <= 0) return found(a + a1 / (a1 - b1) * ab, TrianglePart::Edge0);
  const Eigen::Vector3d cq = query_mm - c;
  const double c1 = ab.dot(cq), c2 = ac.dot(cq);
  if (c2 >= 0 && c1 <= c2) return found(c, TrianglePart::Corner2);
  const double on_ac = c1 * a2 - a1 * c2;
  if (on_ac <= 0 && a2 >= 0 && c2 <= 0) return found(a + a2 / (a2 - c2) * ac, TrianglePart::Edge2);
  const double on_bc = b1 * c2 - c1 * b2;
  if (on_bc <= 0 && b2 - b1 >= 0 && c1 - c2 >= 0) {
    return found(b + (b2 - b1) / ((b2 - b1) + (c1 - c2)) * (c - b), TrianglePart::Edge1);
  }
  const double scale = 1.0 / (on_ab + on_ac + on_bc);
  return found(a + on_ac * scale * ab + on_ab * scale * ac, TrianglePart::Face);
}

PseudoNormals::PseudoNormals(const TriangleMesh& mesh)
    : mesh_(mesh),
      face_(mesh.triangles.size()),
      corner_(mesh.vertices_mm.size(), Eigen::Vector3d::Zero()),
      edge_(mesh.triangles.size()) {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    std::array<Eigen::Vector3d, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] =
          mesh.vertices_mm[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])];
    face_[t] = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = angle_between_rad(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
      corner_[static_cast<std::size_t>(triangle[k])] += angle * face_[t];
      edge_[t][k] = face_[t];
      sides.push_back({edge_key(triangle[k], triangle[(k + 1) % 3]), static_cast<std::int32_t>(t),
                       static_cast<std::uint8_t>(k)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& l, const EdgeSide& r) { return l.key < r.key; });
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (; last < sides.size() && sides[last].key == sides[first].key; ++last) {
      sum += face_[static_cast<std::size_t>(sides[last].triangle)];
    }
    for (; first < last; ++first)
      edge_[static_cast<std::size_t>(sides[first].triangle)][sides[first].edge] = sum;
  }
}

const Eigen::Vector3d& PseudoNormals::at(std::int32_t triangle, TrianglePart part) const {
  const auto t = static_cast<std::size_t>(triangle);
  switch (part) {
    case TrianglePart::Corner0:
      return corner_[static_cast<std::size_t>(mesh_.triangles[t][0])];
    case TrianglePart::Corner1:
      return corner_[static_cast<std::size_t>(mesh_.triangles[t][1])];
    case TrianglePart::Corner2:
      return corner_[static_cast<std::size_t>(mesh_.triangles[t][2])];
    case TrianglePart::Edge0:
      return edge_[t][0];
    case TrianglePart::Edge1:
      return edge_[t][1];
    case TrianglePart::Edge2:
      return edge_[t][2];
    case TrianglePart::Face:
      break;
  }
  return face_[t];
}

}  // namespace arthronaut::geometry
