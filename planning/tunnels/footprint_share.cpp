#include "planning/tunnels/footprint_share.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double area_of(const std::vector<Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

// Sutherland and Hodgman: what of a polygon lies within a convex one that runs counter-clockwise. Parts that
// fall apart stay joined by lines of no area.
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

}  // namespace

FootprintShare footprint_share(const TunnelMouth& mouth, const std::vector<Eigen::Vector3d>& outline_mm) {
  FootprintShare share;
  share.opening_mm2 = mouth.area_mm2;
  if (outline_mm.size() < 3) return share;
  const Eigen::Vector3d short_axis = mouth.normal.cross(mouth.long_axis);
  std::vector<Vector2d> footprint;
  for (const auto& p : outline_mm)
    footprint.emplace_back((p - mouth.at_mm).dot(mouth.long_axis), (p - mouth.at_mm).dot(short_axis));
  if (area_of(footprint) < 0) std::reverse(footprint.begin(), footprint.end());
  share.footprint_mm2 = area_of(footprint);
  constexpr int kCorners = 360;
  const double step = 2 * geometry::kPi / kCorners, widened = std::sqrt(step / std::sin(step));
  std::vector<Vector2d> opening;
  for (int i = 0; i < kCorners; ++i)
    opening.emplace_back(0.5 * widened * mouth.long_mm * std::cos(i * step),
                         0.5 * widened * mouth.short_mm * std::sin(i * step));
  share.shared_mm2 = std::abs(area_of(clipped(footprint, opening)));
  return share;
}

}  // namespace arthronaut::tunnels
