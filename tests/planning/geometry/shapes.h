// Closed meshes of known shape for the tests of surfaces and bones.
#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::test {

// Outward. Corners at +-half_mm from the middle.
inline geometry::TriangleMesh box(const Eigen::Vector3d& half_mm,
                                  const Eigen::Vector3d& middle_mm = Eigen::Vector3d::Zero()) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.vertices_mm.push_back(middle_mm + corner.cwiseProduct(half_mm));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Outward. Corners on the axes.
inline geometry::TriangleMesh octahedron(double radius_mm) {
  geometry::TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1, -1})
      mesh.vertices_mm.push_back(side * radius_mm * Eigen::Vector3d::Unit(axis));
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

// Outward, vertices on the ellipsoid; 20 * 4^rounds triangles.
inline geometry::TriangleMesh ellipsoid(const Eigen::Vector3d& radii_mm, int rounds,
                                        const Eigen::Vector3d& center_mm = Eigen::Vector3d::Zero()) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  geometry::TriangleMesh mesh;
  mesh.vertices_mm = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices_mm.size()));
      if (is_new)
        mesh.vertices_mm.push_back((mesh.vertices_mm[a].normalized() + mesh.vertices_mm[b].normalized()) / 2);
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (auto& v : mesh.vertices_mm) v = center_mm + v.normalized().cwiseProduct(radii_mm);
  return mesh;
}

// A profile (y, z), counter-clockwise seen from +x and star-shaped about `star`, drawn out along x. Outward.
inline geometry::TriangleMesh prism(const std::vector<Eigen::Vector2d>& profile_mm, double half_length_mm,
                                    const Eigen::Vector2d& star_mm) {
  geometry::TriangleMesh mesh;
  const auto count = static_cast<std::int32_t>(profile_mm.size());
  for (const double x : {-half_length_mm, half_length_mm}) {
    for (const auto& p : profile_mm) mesh.vertices_mm.emplace_back(x, p.x(), p.y());
  }
  for (const double x : {-half_length_mm, half_length_mm})
    mesh.vertices_mm.emplace_back(x, star_mm.x(), star_mm.y());
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, next + count});
    mesh.triangles.push_back({i, next + count, i + count});
    mesh.triangles.push_back({2 * count, next, i});
    mesh.triangles.push_back({2 * count + 1, i + count, next + count});
  }
  return mesh;
}

// About z, its facets touching the radius from inside by radius * (1 - cos(pi / facets)). Outward.
inline geometry::TriangleMesh cylinder(double radius_mm, double half_length_mm, int facets) {
  std::vector<Eigen::Vector2d> circle;
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * geometry::kPi * i / facets;
    circle.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
  }
  auto mesh = prism(circle, half_length_mm, Eigen::Vector2d::Zero());
  for (auto& v : mesh.vertices_mm) v = Eigen::Vector3d(v.y(), v.z(), v.x());
  return mesh;
}

inline geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Eigen::Matrix3d& turn,
                                    const Eigen::Vector3d& shift_mm) {
  for (auto& v : mesh.vertices_mm) v = turn * v + shift_mm;
  return mesh;
}

}  // namespace arthronaut::test
