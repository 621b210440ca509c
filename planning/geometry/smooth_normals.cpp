#include "planning/geometry/smooth_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace arthronaut::geometry {

namespace {

using Eigen::Vector3d;

constexpr double kReach_mm = 1.5;
constexpr double kCreaseCosine = 0.76604444311897804;  // 40 deg
constexpr int kMostRounds = 4;

// The triangles at each vertex, one list after the other.
struct Umbrellas {
  std::vector<std::size_t> begins;
  std::vector<std::size_t> triangles;

  explicit Umbrellas(const TriangleMesh& mesh) : begins(mesh.vertices_mm.size() + 1) {
    for (const auto& triangle : mesh.triangles)
      for (const std::int32_t v : triangle) ++begins[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < begins.size(); ++v) begins[v] += begins[v - 1];
    triangles.resize(3 * mesh.triangles.size());
    std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::int32_t v : mesh.triangles[t]) triangles[next[static_cast<std::size_t>(v)]++] = t;
  }
};

// The sum over the triangles at a vertex that face as `like` does, as long as their areas are large.
Vector3d mean_at(std::size_t vertex, const Vector3d& like, const Umbrellas& umbrellas,
                 const std::vector<Vector3d>& normals, const std::vector<double>& areas) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = umbrellas.begins[vertex]; i < umbrellas.begins[vertex + 1]; ++i) {
    const std::size_t t = umbrellas.triangles[i];
    if (normals[t].dot(like) > kCreaseCosine) sum += areas[t] * normals[t];
  }
  return sum;
}

}  // namespace

std::vector<std::array<Vector3d, 3>> smooth_corner_normals(const TriangleMesh& mesh) {
  const Umbrellas umbrellas(mesh);
  std::vector<Vector3d> normals(mesh.triangles.size());
  std::vector<double> areas(mesh.triangles.size());
  double edges_mm = 0;
  const auto corner = [&](std::size_t t, std::size_t k) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[t][k])];
  };
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const Vector3d across = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    areas[t] = 0.5 * across.norm();
    normals[t] = across.normalized();
    for (std::size_t k = 0; k < 3; ++k) edges_mm += (corner(t, (k + 1) % 3) - corner(t, k)).norm();
  }
  const double edge_mm = edges_mm / (3 * static_cast<double>(std::max<std::size_t>(normals.size(), 1)));
  // A round carries a normal about one edge further; the last one is that of the corners.
  const int rounds =
      std::clamp(static_cast<int>(std::lround(kReach_mm / std::max(edge_mm, 1e-3))) - 1, 0, kMostRounds);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vector3d> smoother(normals.size());
    for (std::size_t t = 0; t < normals.size(); ++t) {
      Vector3d sum = areas[t] * normals[t];
      for (const std::int32_t v : mesh.triangles[t])
        sum += mean_at(static_cast<std::size_t>(v), normals[t], umbrellas, normals, areas);
      smoother[t] = sum.normalized();
    }
    normals = std::move(smoother);
  }
  std::vector<std::array<Vector3d, 3>> corners(normals.size());
  for (std::size_t t = 0; t < normals.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      corners[t][k] =
          mean_at(static_cast<std::size_t>(mesh.triangles[t][k]), normals[t], umbrellas, normals, areas)
              .normalized();
  }
  return corners;
}

}  // namespace arthronaut::geometry
