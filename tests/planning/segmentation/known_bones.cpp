#include "tests/planning/segmentation/known_bones.h"

#include <cmath>

#include "planning/geometry/surface.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::test {

using geometry::TriangleMesh;

const std::vector<TriangleMesh>& knee() {
  static const auto phantom = phantom::make_phantom_knee();
  static const std::vector<TriangleMesh> meshes{phantom.femur.mesh, phantom.tibia.mesh};
  return meshes;
}

TriangleMesh fibula_of(const TriangleMesh& tibia) {
  TriangleMesh rod;
  const geometry::Bounds bounds = geometry::bounds_of(tibia);
  constexpr int kSides = 24;
  const Eigen::Vector3d foot(bounds.max_mm.x() + 10, bounds.center_mm().y(), bounds.min_mm.z() + 1);
  const double height = bounds.size_mm().z() - 14;
  for (const double z : {0.0, height}) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * M_PI * i / kSides;
      rod.vertices_mm.push_back(foot + Eigen::Vector3d(6 * std::cos(angle), 6 * std::sin(angle), z));
    }
    rod.vertices_mm.push_back(foot + Eigen::Vector3d(0, 0, z));
  }
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides, above = kSides + 1;
    rod.triangles.push_back({i, next, above + i});
    rod.triangles.push_back({next, above + next, above + i});
    rod.triangles.push_back({kSides, next, i});
    rod.triangles.push_back({above + kSides, above + i, above + next});
  }
  return rod;
}

TriangleMesh fibula_against(const TriangleMesh& tibia) {
  const geometry::Bounds bounds = geometry::bounds_of(tibia);
  const double head_mm = bounds.max_mm.z() - 22, foot_mm = bounds.min_mm.z() + 1;
  constexpr double kHead_mm = 12, kShaft_mm = 6.5, kOverlap_mm = 5, kBetween_mm = 0.1;
  Eigen::Vector3d outermost = bounds.min_mm;
  for (const Eigen::Vector3d& p : tibia.vertices_mm)
    if (std::abs(p.z() - head_mm) < 3 && p.x() > outermost.x()) outermost = p;
  const Eigen::Vector2d axis(outermost.x() + kHead_mm - kOverlap_mm, outermost.y());
  const geometry::Surface surface(tibia);
  constexpr int kSides = 64, kLevels = 120;
  TriangleMesh mesh;
  for (int level = 0; level <= kLevels; ++level) {
    const double z = foot_mm + (head_mm + kHead_mm - foot_mm) * level / kLevels, above = z - head_mm;
    const double ball = std::abs(above) < kHead_mm ? std::sqrt(kHead_mm * kHead_mm - above * above) : 0;
    const double radius = above > 0 ? std::max(ball, 0.01) : std::max(ball, kShaft_mm);
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * M_PI * i / kSides;
      Eigen::Vector3d p(axis.x() + radius * std::cos(angle), axis.y() + radius * std::sin(angle), z);
      const auto closest = surface.closest_point(p);
      if ((p - closest.point_mm).dot(closest.normal) < kBetween_mm)
        p = closest.point_mm + kBetween_mm * closest.normal;
      mesh.vertices_mm.push_back(p);
    }
  }
  for (int level = 0; level < kLevels; ++level)
    for (int i = 0; i < kSides; ++i) {
      const int a = level * kSides + i, b = level * kSides + (i + 1) % kSides;
      mesh.triangles.push_back({a, b, a + kSides});
      mesh.triangles.push_back({b, b + kSides, a + kSides});
    }
  for (const bool is_top : {false, true}) {
    const int ring = is_top ? kLevels * kSides : 0, middle = static_cast<int>(mesh.vertices_mm.size());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < kSides; ++i) sum += mesh.vertices_mm[static_cast<std::size_t>(ring + i)];
    mesh.vertices_mm.push_back(sum / kSides);
    for (int i = 0; i < kSides; ++i) {
      const int a = ring + i, b = ring + (i + 1) % kSides;
      if (is_top)
        mesh.triangles.push_back({a, b, middle});
      else
        mesh.triangles.push_back({b, a, middle});
    }
  }
  return mesh;
}

}  // namespace arthronaut::test
