#include "planning/geometry/surface.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::geometry {

namespace {

// Exact predicates: a ray through an edge or a vertex must not slip between two triangles.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Point to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Eigen::Vector3d to_eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }

// The part of a triangle that a closest point lies on: the face, edge i (from corner i to i + 1) or corner i.
enum class Feature { Face, Edge, Corner };
struct Foot {
  Eigen::Vector3d point;
  Feature feature = Feature::Face;
  int index = 0;
};

// By the regions of the triangle's plane in which the query's foot falls; the sign of the distance hangs on
// the feature, which the coordinates of the foot alone would not tell reliably.
Foot foot_on_triangle(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& corner) {
  const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  bool is_inside = true;
  Foot best;
  double best_squared = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corner[i];
    const Eigen::Vector3d edge = corner[(i + 1) % 3] - a, from_a = p - a;
    if (normal.cross(edge).dot(from_a) >= 0) continue;  // on the inner side of this edge
    is_inside = false;
    const double s = from_a.dot(edge) / edge.squaredNorm();
    Foot foot;
    if (s <= 0) {
      foot = {a, Feature::Corner, i};
    } else if (s >= 1) {
      foot = {corner[(i + 1) % 3], Feature::Corner, (i + 1) % 3};
    } else {
      foot = {a + s * edge, Feature::Edge, i};
    }
    const double squared = (p - foot.point).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best = foot;
    }
  }
  if (is_inside) best.point = p - normal * (normal.dot(p - corner[0]) / normal.squaredNorm());
  return best;
}

std::pair<std::int32_t, std::int32_t> edge_key(std::int32_t a, std::int32_t b) { return std::minmax(a, b); }

}  // namespace

struct Surface::Tree {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> mesh_triangle;           // index in the mesh given
  std::vector<std::array<std::int32_t, 3>> corners;  // points of the same place share an index
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;                      // unit, of the triangles
  std::vector<Eigen::Vector3d> corner_normals;               // angle-weighted, not unit
  std::vector<std::array<Eigen::Vector3d, 3>> edge_normals;  // sum over the triangles at each edge, not unit
  AabbTree aabb;

  void add_triangles(const TriangleMesh& mesh);
  void weigh_normals();
  [[nodiscard]] std::pair<Foot, std::size_t> closest(const Eigen::Vector3d& query) const;
  [[nodiscard]] std::size_t index_of(AabbTree::Primitive_id id) const {
    return static_cast<std::size_t>(id - triangles.cbegin());
  }
};

void Surface::Tree::add_triangles(const TriangleMesh& mesh) {
  // Points of the same place become one: a triangle soup has normals at its edges all the same.
  std::vector<std::int32_t> order(mesh.vertices_mm.size()), merged(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  const auto less = [&](std::int32_t a, std::int32_t b) {
    const auto &p = mesh.vertices_mm[a], &q = mesh.vertices_mm[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  for (const std::int32_t i : order) {
    if (points.empty() || points.back() != mesh.vertices_mm[i]) points.push_back(mesh.vertices_mm[i]);
    merged[i] = static_cast<std::int32_t>(points.size()) - 1;
  }
  triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::int32_t, 3> c{};
    for (int i = 0; i < 3; ++i) {
      const std::int32_t v = mesh.triangles[t][i];
      if (v < 0 || static_cast<std::size_t>(v) >= merged.size()) {
        throw InvalidInput("mesh: triangle " + std::to_string(t) + ": refers to vertex " + std::to_string(v) +
                           " of " + std::to_string(merged.size()));
      }
      c[i] = merged[v];
    }
    const Eigen::Vector3d normal = (points[c[1]] - points[c[0]]).cross(points[c[2]] - points[c[0]]);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    Triangle triangle(to_cgal(points[c[0]]), to_cgal(points[c[1]]), to_cgal(points[c[2]]));
    if (triangle.is_degenerate()) continue;
    triangles.push_back(triangle);
    mesh_triangle.push_back(static_cast<std::int32_t>(t));
    corners.push_back(c);
    normals.push_back(normal / length);
  }
  if (triangles.empty()) throw InvalidInput("mesh: holds no triangle with an area");
}

// Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal (2005): the dot
// product with these normals has the right sign wherever the closest point lies on an edge or a corner of a
// closed mesh.
void Surface::Tree::weigh_normals() {
  corner_normals.assign(points.size(), Eigen::Vector3d::Zero());
  std::vector<std::pair<std::pair<std::int32_t, std::int32_t>, std::size_t>> edges;
  edges.reserve(3 * corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto a = corners[t][i], b = corners[t][(i + 1) % 3], c = corners[t][(i + 2) % 3];
      corner_normals[a] += angle_between_rad(points[b] - points[a], points[c] - points[a]) * normals[t];
      edges.push_back({edge_key(a, b), 3 * t + static_cast<std::size_t>(i)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edge_normals.resize(corners.size());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (end = begin; end < edges.size() && edges[end].first == edges[begin].first; ++end) {
      sum += normals[edges[end].second / 3];
    }
    for (std::size_t k = begin; k < end; ++k) edge_normals[edges[k].second / 3][edges[k].second % 3] = sum;
  }
}

std::pair<Foot, std::size_t> Surface::Tree::closest(const Eigen::Vector3d& query) const {
  const auto found = aabb.closest_point_and_primitive(to_cgal(query));
  const std::size_t t = index_of(found.second);
  return {foot_on_triangle(query, {points[corners[t][0]], points[corners[t][1]], points[corners[t][2]]}), t};
}

Surface::Surface(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  tree_->add_triangles(mesh);
  tree_->weigh_normals();
  tree_->aabb.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  // Both are lazy otherwise; after this, queries only read.
  tree_->aabb.build();
  tree_->aabb.accelerate_distance_queries();
}

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

SurfacePoint Surface::closest_point(const Eigen::Vector3d& query_mm) const {
  const auto [foot, t] = tree_->closest(query_mm);
  return {foot.point, tree_->normals[t], tree_->mesh_triangle[t]};
}

double Surface::signed_distance_mm(const Eigen::Vector3d& query_mm) const {
  const auto [foot, t] = tree_->closest(query_mm);
  const Eigen::Vector3d offset = query_mm - foot.point;
  const Eigen::Vector3d& normal = foot.feature == Feature::Face ? tree_->normals[t]
                                  : foot.feature == Feature::Edge
                                      ? tree_->edge_normals[t][foot.index]
                                      : tree_->corner_normals[tree_->corners[t][foot.index]];
  return std::copysign(offset.norm(), offset.dot(normal));
}

std::vector<RayHit> Surface::all_hits(const Eigen::Vector3d& origin_mm,
                                      const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.normalized();
  const Kernel::Ray_3 ray(to_cgal(origin_mm), Kernel::Vector_3(unit.x(), unit.y(), unit.z()));
  std::vector<AabbTree::Intersection_and_primitive_id<Kernel::Ray_3>::Type> found;
  tree_->aabb.all_intersections(ray, std::back_inserter(found));
  std::vector<RayHit> hits;
  for (const auto& [where, id] : found) {
    const std::size_t t = tree_->index_of(id);
    // A ray that runs within a triangle's plane meets it in a segment: it neither enters nor leaves there.
    const Point* point = boost::get<Point>(&where);
    if (!point) continue;
    RayHit hit;
    hit.point_mm = to_eigen(*point);
    hit.normal = tree_->normals[t];
    hit.triangle = tree_->mesh_triangle[t];
    hit.distance_mm = std::max(0.0, (hit.point_mm - origin_mm).dot(unit));
    hits.push_back(hit);
  }
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
    return std::tie(a.distance_mm, a.triangle) < std::tie(b.distance_mm, b.triangle);
  });
  // A ray through an edge or a vertex meets all the triangles there: it enters, or leaves, once.
  const auto is_same_crossing = [&](const RayHit& a, const RayHit& b) {
    return b.distance_mm - a.distance_mm <= 1e-9 * (1 + b.distance_mm) &&
           (a.normal.dot(unit) < 0) == (b.normal.dot(unit) < 0);
  };
  hits.erase(std::unique(hits.begin(), hits.end(), is_same_crossing), hits.end());
  return hits;
}

std::optional<RayHit> Surface::first_hit(const Eigen::Vector3d& origin_mm,
                                         const Eigen::Vector3d& direction) const {
  auto hits = all_hits(origin_mm, direction);
  if (hits.empty()) return std::nullopt;
  return hits.front();
}

}  // namespace arthronaut::geometry
