#include "planning/geometry/surface_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::geometry {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Twice the vector of the area that a closed line in space bounds.
Vector3d twice_area(const std::vector<Vector3d>& outline) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    sum += (outline[i] - outline[0]).cross(outline[i + 1] - outline[0]);
  return sum;
}

// The outline as it is seen along its own normal.
struct SeenOutline {
  Vector3d middle_mm = Vector3d::Zero(), normal, right, up;
  std::vector<Vector2d> polygon;  // counter-clockwise
  Eigen::AlignedBox2d box;
  double behind_mm = 0, before_mm = 0;  // how far along the normal the surface is looked at
  double radius_mm = 0;                 // about the middle

  [[nodiscard]] Vector2d seen(const Vector3d& p) const {
    return {(p - middle_mm).dot(right), (p - middle_mm).dot(up)};
  }
};

SeenOutline seen_straight_on(const Surface& surface, std::vector<Vector3d> outline_mm) {
  SeenOutline outline;
  for (const Vector3d& p : outline_mm) outline.middle_mm += p / static_cast<double>(outline_mm.size());
  outline.normal = twice_area(outline_mm).normalized();
  // Outward; the line may run either way round.
  if (outline.normal.dot(surface.closest_point(outline.middle_mm).normal) < 0) {
    outline.normal = -outline.normal;
    std::ranges::reverse(outline_mm);
  }
  outline.right = outline.normal.unitOrthogonal();
  outline.up = outline.normal.cross(outline.right);
  for (const Vector3d& p : outline_mm) {
    outline.polygon.push_back(outline.seen(p));
    outline.box.extend(outline.polygon.back());
    outline.radius_mm = std::max(outline.radius_mm, outline.polygon.back().norm());
    const double height_mm = (p - outline.middle_mm).dot(outline.normal);
    outline.behind_mm = std::min(outline.behind_mm, height_mm);
    outline.before_mm = std::max(outline.before_mm, height_mm);
  }
  const double slack_mm = 0.5 * outline.box.sizes().maxCoeff();
  outline.behind_mm -= slack_mm;
  outline.before_mm += slack_mm;
  return outline;
}

}  // namespace

std::vector<Vector2d> clipped(std::vector<Vector2d> polygon, const std::vector<Vector2d>& convex) {
  for (std::size_t i = 0; i < convex.size() && !polygon.empty(); ++i) {
    const Vector2d &from = convex[i], edge = convex[(i + 1) % convex.size()] - from;
    std::vector<Vector2d> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double of_a = cross(edge, a - from), of_b = cross(edge, b - from);
      if (of_a >= 0) kept.push_back(a);
      if ((of_a >= 0) != (of_b >= 0)) kept.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

double area_of(const std::vector<Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

double PatchPiece::area_mm2() const { return 0.5 * twice_area(corners_mm).dot(normal); }

SurfacePatch patch_within(const Surface& surface, const std::vector<Vector3d>& outline_mm) {
  SurfacePatch patch;
  constexpr double kLeastArea_mm2 = 1e-6;
  if (outline_mm.size() < 3 || twice_area(outline_mm).norm() < kLeastArea_mm2) return patch;
  const SeenOutline outline = seen_straight_on(surface, outline_mm);
  constexpr double kLeastFacing = 0.0872;  // cos 85 deg: what is seen edge on has no certain area
  const TriangleMesh& mesh = surface.mesh();
  std::vector<std::int32_t> near;
  surface.triangles_near(outline.middle_mm + outline.behind_mm * outline.normal,
                         outline.middle_mm + outline.before_mm * outline.normal, outline.radius_mm, near);
  std::ranges::sort(near);  // the same sum however the tree was built
  for (const std::int32_t of_mesh : near) {
    const auto t = static_cast<std::size_t>(of_mesh);
    const Vector3d& normal = surface.normal(of_mesh);
    const double facing = normal.dot(outline.normal);
    if (facing < kLeastFacing) continue;
    std::array<Vector2d, 3> corners;
    Eigen::AlignedBox2d box;
    double least_mm = 1e9, greatest_mm = -1e9;
    const Vector3d& first = mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[t][0])];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3d& p = mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[t][i])];
      const double height_mm = (p - outline.middle_mm).dot(outline.normal);
      least_mm = std::min(least_mm, height_mm);
      greatest_mm = std::max(greatest_mm, height_mm);
      corners[i] = outline.seen(p);
      box.extend(corners[i]);
    }
    if (greatest_mm < outline.behind_mm || least_mm > outline.before_mm || !box.intersects(outline.box))
      continue;
    const std::vector<Vector2d> triangle(corners.begin(), corners.end());
    const std::vector<Vector2d> within = clipped(outline.polygon, triangle);
    if (within.size() < 3) continue;
    PatchPiece piece{.normal = normal, .corners_mm = {}};
    for (const Vector2d& at : within) {  // back onto the triangle
      const Vector3d flat = outline.middle_mm + at.x() * outline.right + at.y() * outline.up;
      piece.corners_mm.push_back(flat + (first - flat).dot(normal) / facing * outline.normal);
    }
    patch.area_mm2 += piece.area_mm2();
    patch.pieces.push_back(std::move(piece));
  }
  return patch;
}

}  // namespace arthronaut::geometry
