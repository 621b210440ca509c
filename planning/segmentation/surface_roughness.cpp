#include "planning/segmentation/surface_roughness.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "planning/geometry/quantile.h"

namespace arthronaut::segmentation {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kPatches = 600;
// Six numbers are fitted; of fewer vertices the rest says nothing.
constexpr std::size_t kLeastVertices = 15;

// Vertices in cubes as wide as a patch's radius.
class Cubes {
 public:
  explicit Cubes(const std::vector<Vector3d>& points_mm) : points_mm_(points_mm) {
    for (std::size_t i = 0; i < points_mm.size(); ++i) cubes_[cube_of(points_mm[i])].push_back(i);
  }

  template <typename Visit>
  void visit_near(const Vector3d& p_mm, const Visit& visit) const {
    const auto [x, y, z] = cube_of(p_mm);
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto cube = cubes_.find({x + i, y + j, z + k});
          if (cube == cubes_.end()) continue;
          for (const std::size_t v : cube->second)
            if ((points_mm_[v] - p_mm).squaredNorm() < kPatchRadius_mm * kPatchRadius_mm) visit(v);
        }
      }
    }
  }

 private:
  using Cube = std::tuple<int, int, int>;
  [[nodiscard]] static Cube cube_of(const Vector3d& p_mm) {
    const Eigen::Vector3i at = (p_mm / kPatchRadius_mm).array().floor().cast<int>();
    return {at.x(), at.y(), at.z()};
  }

  const std::vector<Vector3d>& points_mm_;
  std::map<Cube, std::vector<std::size_t>> cubes_;
};

std::optional<double> off_quadric_mm(const geometry::TriangleMesh& mesh, const std::vector<Vector3d>& normals,
                                     const Cubes& cubes, std::size_t center) {
  const Vector3d& p = mesh.vertices_mm[center];
  Vector3d out = Vector3d::Zero();
  cubes.visit_near(p, [&](std::size_t v) {
    if (normals[v].dot(normals[center]) > 0) out += normals[v];
  });
  if (out.norm() < 1e-9) return std::nullopt;
  out.normalize();
  const Vector3d u = out.unitOrthogonal(), w = out.cross(u);
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6d right = Vector6d::Zero();
  double squares = 0;
  std::size_t count = 0;
  cubes.visit_near(p, [&](std::size_t v) {
    if (normals[v].dot(out) < -0.2) return;  // the other side of something thin
    const Vector3d to = mesh.vertices_mm[v] - p;
    const double x = to.dot(u), y = to.dot(w), height = to.dot(out);
    const Vector6d row{1, x, y, x * x, x * y, y * y};
    normal += row * row.transpose();
    right += height * row;
    squares += height * height;
    ++count;
  });
  if (count < kLeastVertices) return std::nullopt;
  const Vector6d best = normal.ldlt().solve(right);
  return std::sqrt(std::max(0.0, squares - best.dot(right)) / static_cast<double>(count));
}

}  // namespace

double roughness_mm(const geometry::TriangleMesh& mesh) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh);
  const Cubes cubes(mesh.vertices_mm);
  const std::size_t stride = std::max<std::size_t>(1, mesh.vertices_mm.size() / kPatches);
  std::vector<double> off;
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); v += stride)
    if (const auto patch = off_quadric_mm(mesh, normals, cubes, v)) off.push_back(*patch);
  return off.empty() ? 0 : geometry::median(std::move(off), 0.0);
}

}  // namespace arthronaut::segmentation
