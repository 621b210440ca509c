#include "planning/painting/bone_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace arthronaut::painting {

namespace {

// Rows of voxels are looked along this far beside their centres, so that none meets an edge or a vertex of a
// mesh that was made in the same grid.
constexpr double kBeside_j = 1.3e-6, kBeside_k = 2.7e-6;

// Where a surface crosses a row of voxels, and whether it goes in (+1) or out (-1).
struct Crossing {
  std::size_t row = 0;
  double at = 0;
  int turn = 0;
};

// Of rows (j, k) with the triangle, all in voxel indices.
void add_crossings(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3i& size,
                   std::vector<Crossing>& crossings) {
  const auto across = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double j, double k) {
    return (to.y() - from.y()) * (k - from.z()) - (to.z() - from.z()) * (j - from.y());
  };
  const auto& [a, b, c] = corners;
  const double area = across(a, b, c.y(), c.z());
  if (area == 0) return;  // along the rows
  const auto first = [](double least) { return std::max(static_cast<int>(std::ceil(least)), 0); };
  const auto last = [](double most, int count) {
    return std::min(static_cast<int>(std::floor(most)), count - 1);
  };
  const auto [j0, j1] = std::minmax({a.y(), b.y(), c.y()});
  const auto [k0, k1] = std::minmax({a.z(), b.z(), c.z()});
  for (int k = first(k0 - kBeside_k); k <= last(k1 - kBeside_k, size.z()); ++k) {
    for (int j = first(j0 - kBeside_j); j <= last(j1 - kBeside_j, size.y()); ++j) {
      const double y = j + kBeside_j, z = k + kBeside_k;
      const double u = across(b, c, y, z) / area, v = across(c, a, y, z) / area, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      crossings.push_back(
          {static_cast<std::size_t>(j) + static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k),
           u * a.x() + v * b.x() + w * c.x(), area > 0 ? -1 : 1});
    }
  }
}

}  // namespace

void add_bone(Labels& labels, const images::Volume& grid, const geometry::TriangleMesh& mesh,
              std::uint8_t label) {
  const Eigen::Affine3d index_from_lps = grid.lps_from_index.inverse();
  std::vector<Eigen::Vector3d> vertices;
  vertices.reserve(mesh.vertices_mm.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices_mm) vertices.push_back(index_from_lps * vertex);
  std::vector<Crossing> crossings;
  for (const auto& triangle : mesh.triangles)
    add_crossings(
        {vertices[static_cast<std::size_t>(triangle[0])], vertices[static_cast<std::size_t>(triangle[1])],
         vertices[static_cast<std::size_t>(triangle[2])]},
        grid.size, crossings);
  std::ranges::sort(crossings, [](const Crossing& x, const Crossing& y) {
    return x.row != y.row ? x.row < y.row : x.at < y.at;
  });
  const auto width = static_cast<std::size_t>(grid.size.x());
  int inside = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    const Crossing& here = crossings[i];
    if (i == 0 || crossings[i - 1].row != here.row) inside = 0;
    inside += here.turn;
    if (inside == 0 || crossings[i + 1].row != here.row) continue;
    const double from = std::max(std::ceil(here.at), 0.0);
    const double to = std::min(std::floor(crossings[i + 1].at), static_cast<double>(width) - 1);
    for (double x = from; x <= to; ++x) labels[here.row * width + static_cast<std::size_t>(x)] = label;
  }
}

std::uint64_t digest_of(std::span<const std::uint8_t> labels, std::uint8_t label) {
  std::uint64_t digest = 14695981039346656037U;  // FNV-1a over the ends of the label's runs
  const auto take = [&](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) digest = (digest ^ (value >> (8 * byte) & 255U)) * 1099511628211U;
  };
  bool was_inside = false;
  for (std::size_t voxel = 0; voxel < labels.size(); ++voxel) {
    if ((labels[voxel] == label) == was_inside) continue;
    was_inside = !was_inside;
    take(voxel);
  }
  if (was_inside) take(labels.size());
  return digest;
}

}  // namespace arthronaut::painting
