#include "planning/geometry/surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "planning/geometry/error.h"
#include "planning/geometry/smooth_normals.h"
#include "planning/geometry/triangle_distance.h"
#include "planning/geometry/triangle_tree.h"

namespace arthronaut::geometry {

namespace {

// Exact predicates: a ray through an edge or a vertex must not slip between two triangles.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;

Point to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Eigen::Vector3d to_eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }
Kernel::Ray_3 ray_of(const Eigen::Vector3d& origin, const Eigen::Vector3d& unit) {
  return {to_cgal(origin), Kernel::Vector_3(unit.x(), unit.y(), unit.z())};
}
// Of the boxes; what a ray meets is decided by the exact predicates.
constexpr double kRounding_mm = 1e-6;
bool is_before(const RayHit& a, const RayHit& b) {
  return std::tie(a.distance_mm, a.triangle) < std::tie(b.distance_mm, b.triangle);
}

}  // namespace

struct Surface::Tree {
  std::vector<std::int32_t> mesh_triangle;  // index in the mesh given
  TriangleMesh merged;  // without degenerate triangles; points of the same place share an index
  std::optional<PseudoNormals> normals;  // of merged
  std::optional<TriangleTree> boxes;     // of merged
  std::vector<std::array<Eigen::Vector3d, 3>> smooth_normals;
  Bounds bounds;  // of merged

  void add_triangles(const TriangleMesh& mesh);
  [[nodiscard]] const Eigen::Vector3d& normal(std::size_t triangle,
                                              TrianglePart part = TrianglePart::Face) const {
    return normals->at(static_cast<std::int32_t>(triangle), part);
  }
  // Whether a line passes a triangle so far beside it that no rounding matters: it then has two of its edges
  // on different sides. Most triangles near a ray are passed, and the exact predicates cost twenty times as
  // much.
  [[nodiscard]] bool passes(std::int32_t triangle, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& unit) const {
    constexpr double kRounding = 1e-11;  // of an area between places as far off as these
    const auto& corners = merged.triangles[static_cast<std::size_t>(triangle)];
    std::array<Eigen::Vector3d, 3> from_origin;
    double furthest = origin.cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < 3; ++k) {
      from_origin[k] = merged.vertices_mm[static_cast<std::size_t>(corners[k])] - origin;
      furthest = std::max(furthest, from_origin[k].cwiseAbs().maxCoeff());
    }
    double least = 0, greatest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = unit.dot(from_origin[k].cross(from_origin[(k + 1) % 3]));
      least = std::min(least, side), greatest = std::max(greatest, side);
    }
    const double rounding = kRounding * furthest * furthest;
    return least < -rounding && greatest > rounding;
  }
  // Where the ray crosses a triangle, by exact predicates. One that runs within the triangle's plane meets it
  // in a segment: it neither enters nor leaves there.
  [[nodiscard]] std::optional<RayHit> hit(std::int32_t triangle, const Kernel::Ray_3& ray,
                                          const Eigen::Vector3d& origin, const Eigen::Vector3d& unit) const {
    if (passes(triangle, origin, unit)) return std::nullopt;
    const auto t = static_cast<std::size_t>(triangle);
    const auto at = [&](std::size_t k) {
      return to_cgal(merged.vertices_mm[static_cast<std::size_t>(merged.triangles[t][k])]);
    };
    const auto met = CGAL::intersection(Triangle(at(0), at(1), at(2)), ray);
    const Point* const point = met ? boost::get<Point>(&*met) : nullptr;
    if (!point) return std::nullopt;
    const Eigen::Vector3d where = to_eigen(*point);
    return RayHit{{where, normal(t), mesh_triangle[t]}, std::max(0.0, (where - origin).dot(unit))};
  }
  // No part of the surface lies further off.
  [[nodiscard]] double furthest_mm(const Eigen::Vector3d& from) const {
    return (bounds.center_mm() - from).norm() + bounds.size_mm().norm();
  }
};

void Surface::Tree::add_triangles(const TriangleMesh& mesh) {
  // Points of the same place become one: a triangle soup has normals at its edges all the same.
  std::vector<Eigen::Vector3d>& points = merged.vertices_mm;
  std::vector<std::int32_t> order(mesh.vertices_mm.size()), index(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  const auto less = [&](std::int32_t a, std::int32_t b) {
    const auto &p = mesh.vertices_mm[a], &q = mesh.vertices_mm[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  for (const std::int32_t i : order) {
    if (points.empty() || points.back() != mesh.vertices_mm[i]) points.push_back(mesh.vertices_mm[i]);
    index[i] = static_cast<std::int32_t>(points.size()) - 1;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::int32_t, 3> c{};
    for (int i = 0; i < 3; ++i) {
      const std::int32_t v = mesh.triangles[t][i];
      if (v < 0 || static_cast<std::size_t>(v) >= index.size()) {
        throw InvalidInput("mesh: triangle " + std::to_string(t) + ": refers to vertex " + std::to_string(v) +
                           " of " + std::to_string(index.size()));
      }
      c[i] = index[v];
    }
    const Eigen::Vector3d normal = (points[c[1]] - points[c[0]]).cross(points[c[2]] - points[c[0]]);
    if (!(normal.norm() > 0)) continue;
    Triangle triangle(to_cgal(points[c[0]]), to_cgal(points[c[1]]), to_cgal(points[c[2]]));
    if (triangle.is_degenerate()) continue;
    mesh_triangle.push_back(static_cast<std::int32_t>(t));
    merged.triangles.push_back(c);
  }
  if (merged.triangles.empty()) throw InvalidInput("mesh: holds no triangle with an area");
  normals.emplace(merged);
  boxes.emplace(merged);
  smooth_normals = smooth_corner_normals(merged);
  bounds = bounds_of(merged);
}

Surface::Surface(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) { tree_->add_triangles(mesh); }

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

SurfacePoint Surface::closest_point(const Eigen::Vector3d& query_mm) const {
  const auto [nearest, triangle] = tree_->boxes->nearest(query_mm);
  const auto t = static_cast<std::size_t>(triangle);
  return {nearest.point_mm, tree_->normal(t), tree_->mesh_triangle[t]};
}

double Surface::signed_distance_mm(const Eigen::Vector3d& query_mm) const {
  const auto [nearest, triangle] = tree_->boxes->nearest(query_mm);
  const Eigen::Vector3d offset = query_mm - nearest.point_mm;
  return std::copysign(offset.norm(), offset.dot(tree_->normals->at(triangle, nearest.part)));
}

std::vector<RayHit> Surface::all_hits(const Eigen::Vector3d& origin_mm,
                                      const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.normalized();
  const Kernel::Ray_3 ray = ray_of(origin_mm, unit);
  thread_local std::vector<std::int32_t> near;  // kept for the next one
  near.clear();
  tree_->boxes->near_segment(origin_mm, origin_mm + tree_->furthest_mm(origin_mm) * unit, kRounding_mm, near);
  std::vector<RayHit> hits;
  for (const std::int32_t t : near) {
    if (const auto hit = tree_->hit(t, ray, origin_mm, unit)) hits.push_back(*hit);
  }
  std::sort(hits.begin(), hits.end(), is_before);
  // A ray through an edge or a vertex meets all the triangles there: it enters, or leaves, once.
  const auto is_same_crossing = [&](const RayHit& a, const RayHit& b) {
    return b.distance_mm - a.distance_mm <= 1e-9 * (1 + b.distance_mm) &&
           (a.normal.dot(unit) < 0) == (b.normal.dot(unit) < 0);
  };
  hits.erase(std::unique(hits.begin(), hits.end(), is_same_crossing), hits.end());
  return hits;
}

const TriangleMesh& Surface::mesh() const { return tree_->merged; }

const Eigen::Vector3d& Surface::normal(std::int32_t triangle) const {
  return tree_->normal(static_cast<std::size_t>(triangle));
}

const std::array<Eigen::Vector3d, 3>& Surface::smooth_normals(std::int32_t triangle) const {
  return tree_->smooth_normals[static_cast<std::size_t>(triangle)];
}

void Surface::triangles_near(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm,
                             std::vector<std::int32_t>& found) const {
  tree_->boxes->near_segment(from_mm, to_mm, radius_mm, found);
}

std::optional<RayHit> Surface::first_hit(const Eigen::Vector3d& origin_mm, const Eigen::Vector3d& direction,
                                         double within_mm) const {
  constexpr double kFirstReach_mm = 16;
  const Eigen::Vector3d unit = direction.normalized();
  const Kernel::Ray_3 ray = ray_of(origin_mm, unit);
  const double furthest_mm = std::min(within_mm, tree_->furthest_mm(origin_mm));
  // What lies behind the first hit is not asked: the ray is followed in longer and longer stretches until one
  // holds a hit.
  // A drill's exit is looked for in every frame: kept for the next one.
  thread_local std::vector<std::int32_t> near;
  std::optional<RayHit> first;
  for (double reach_mm = std::min(kFirstReach_mm, furthest_mm), before_mm = 0; before_mm < furthest_mm;
       before_mm = reach_mm, reach_mm = std::min(2 * reach_mm, furthest_mm)) {
    near.clear();
    tree_->boxes->near_segment(origin_mm + before_mm * unit, origin_mm + reach_mm * unit, kRounding_mm, near);
    for (const std::int32_t t : near) {
      const auto hit = tree_->hit(t, ray, origin_mm, unit);
      if (hit && (!first || is_before(*hit, *first))) first = hit;
    }
    if (first && first->distance_mm < reach_mm - kRounding_mm) return first;
  }
  if (first && first->distance_mm > within_mm) return std::nullopt;
  return first;
}

}  // namespace arthronaut::geometry
