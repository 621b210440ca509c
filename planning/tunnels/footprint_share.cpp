#include "planning/tunnels/footprint_share.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

using Eigen::Vector2d;
using Eigen::Vector3d;

FootprintShare footprint_share(const Tunnel& tunnel, const geometry::SurfacePatch& footprint) {
  FootprintShare share;
  share.footprint_mm2 = footprint.area_mm2;
  const Vector3d& along = tunnel.direction;
  const Vector3d right = along.unitOrthogonal(), up = along.cross(right);
  constexpr int kCorners = 90;
  const double step = 2 * geometry::kPi / kCorners, radius_mm = 0.5 * tunnel.diameter_mm;
  const double widened_mm = radius_mm * std::sqrt(step / std::sin(step));
  std::vector<Vector2d> circle;
  for (int i = 0; i < kCorners; ++i)
    circle.emplace_back(widened_mm * std::cos(i * step), widened_mm * std::sin(i * step));
  constexpr double kEdgeOn = 0.02;  // seen like this a part has no area to take a share of
  double seen_mm2 = 0;
  for (const geometry::PatchPiece& piece : footprint.pieces) {
    std::vector<Vector2d> seen;  // along the axis
    bool is_inside = true;
    Eigen::AlignedBox2d box;
    for (const Vector3d& p : piece.corners_mm) {
      seen.emplace_back((p - tunnel.entry_mm).dot(right), (p - tunnel.entry_mm).dot(up));
      is_inside = is_inside && seen.back().norm() <= radius_mm;
      box.extend(seen.back());
    }
    if (box.exteriorDistance(Vector2d::Zero()) > widened_mm) continue;
    const double whole_mm2 = std::abs(geometry::area_of(seen)), facing = -piece.normal.dot(along);
    const double opened_mm2 =
        is_inside ? whole_mm2 : std::abs(geometry::area_of(geometry::clipped(seen, circle)));
    if (facing > 0) seen_mm2 += opened_mm2;  // where the drill goes in, not where it comes out again
    if (is_inside) {
      share.shared_mm2 += piece.area_mm2();
    } else if (std::abs(facing) > kEdgeOn) {
      share.shared_mm2 += opened_mm2 / std::abs(facing);
    } else if (box.center().norm() <= radius_mm) {
      share.shared_mm2 += piece.area_mm2();
    }
  }
  // Two sheets of a folded footprint count once.
  share.of_opening = std::min(seen_mm2 / (geometry::kPi * radius_mm * radius_mm), 1.0);
  return share;
}

}  // namespace arthronaut::tunnels
