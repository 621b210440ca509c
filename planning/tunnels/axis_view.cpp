#include "planning/tunnels/axis_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double distance_to_segment(const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(-from.dot(along) / squared, 0.0, 1.0) : 0.0;
  return (from + t * along).norm();
}

// From the axis, seen along it: 0 where it goes through the triangle's picture.
double nearest_to_axis(const std::array<Vector3d, 3>& corners) {
  const std::array<Vector2d, 3> flat{corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()};
  bool has_left = false, has_right = false;
  double least = flat[0].norm();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector2d &a = flat[k], &b = flat[(k + 1) % 3];
    const double side = a.x() * b.y() - a.y() * b.x();
    has_left = has_left || side > 0;
    has_right = has_right || side < 0;
    least = std::min(least, distance_to_segment(a, b));
  }
  return has_left && has_right ? least : 0;
}

}  // namespace

AxisView::AxisView(const geometry::Surface& bone, const Vector3d& entry_mm, const Vector3d& direction,
                   double from_station_mm, double to_station_mm, double reach_mm)
    : entry_mm_(entry_mm),
      direction_(direction),
      across_(direction.unitOrthogonal()),
      further_across_(direction.cross(across_)) {
  std::vector<std::int32_t> found;
  bone.triangles_near(entry_mm + from_station_mm * direction, entry_mm + to_station_mm * direction, reach_mm,
                      found);
  std::sort(found.begin(), found.end());  // the same numbers however the tree was built
  const geometry::TriangleMesh& mesh = bone.mesh();
  const auto into_view = [&](const Vector3d& v) {
    return Vector3d(v.dot(across_), v.dot(further_across_), v.dot(direction_));
  };
  triangles_.reserve(found.size());
  for (const std::int32_t t : found) {
    AxisTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k]);
      triangle.corners_mm[k] = into_view(mesh.vertices_mm[corner] - entry_mm);
    }
    const auto [low, high] =
        std::minmax({triangle.corners_mm[0].z(), triangle.corners_mm[1].z(), triangle.corners_mm[2].z()});
    if (high < from_station_mm || low > to_station_mm) continue;
    triangle.nearest_mm = nearest_to_axis(triangle.corners_mm);
    if (triangle.nearest_mm > reach_mm) continue;
    triangle.normal = into_view(bone.normal(t));
    for (std::size_t k = 0; k < 3; ++k) triangle.smooth_normals[k] = into_view(bone.smooth_normals(t)[k]);
    triangles_.push_back(triangle);
  }
}

}  // namespace arthronaut::tunnels
