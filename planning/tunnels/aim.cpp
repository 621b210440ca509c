#include "planning/tunnels/aim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

// A wall beyond this is as good as any; a mm of misfit in length outweighs all of it.
constexpr double kThickWall_mm = 6, kMisfitPerMm = 10, kTiltPerDeg = 0.12;

double merit_of(const TunnelGeometry& measured, double tilt_deg, const AimOptions& options) {
  const double misfit_mm = std::max(
      {0.0, options.least_length_mm - measured.length_mm, measured.length_mm - options.greatest_length_mm});
  return std::min(measured.wall_mm, kThickWall_mm) - kMisfitPerMm * misfit_mm - kTiltPerDeg * tilt_deg;
}

}  // namespace

Eigen::Vector3d customary_direction(bones::BoneKind kind, bones::Side side) {
  const double lateral = side == bones::Side::Right ? -1 : 1;
  const Eigen::Vector3d direction = kind == bones::BoneKind::Femur
                                        ? Eigen::Vector3d(0.72 * lateral, -0.32, 0.62)
                                        : Eigen::Vector3d(-0.36 * lateral, -0.47, -0.80);
  return direction.normalized();
}

AimOptions customary_aim(bones::BoneKind kind) {
  if (kind == bones::BoneKind::Femur) return {};
  return {.least_length_mm = 36, .greatest_length_mm = 44};
}

Tunnel aim(const Tunnel& tunnel, const geometry::Surface& bone, const AimOptions& options) {
  constexpr int kTurns = 12;
  const Eigen::Vector3d axis = tunnel.direction.normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
  Tunnel best = tunnel;
  double best_merit = -std::numeric_limits<double>::infinity();
  for (const double share : std::array{0.0, 0.35, 0.7, 1.0}) {
    const double tilt_deg = share * options.greatest_tilt_deg, tilt = geometry::rad_from_deg(tilt_deg);
    for (int turn = 0; turn < (share > 0 ? kTurns : 1); ++turn) {
      const double angle = 2 * geometry::kPi * turn / kTurns;
      Tunnel candidate = tunnel;
      candidate.direction =
          (std::cos(tilt) * axis + std::sin(tilt) * (std::cos(angle) * side + std::sin(angle) * up))
              .normalized();
      const TunnelGeometry measured = measure(candidate, bone);
      if (!measured.enters_bone) continue;
      if (const double merit = merit_of(measured, tilt_deg, options); merit > best_merit) {
        best_merit = merit;
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace arthronaut::tunnels
