#include "planning/tunnels/aim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/plan_norms.h"

namespace arthronaut::tunnels {

namespace {

// A wall beyond this is as good as any; a mm of misfit in length outweighs all of it.
constexpr double kThickWall_mm = 6, kMisfitPerMm = 10, kTiltPerDeg = 0.12;

// What the wall may add stands apart: it costs far more to measure than the length.
double merit_without_wall(double length_mm, double tilt_deg, const AimOptions& options) {
  const double misfit_mm =
      std::max({0.0, options.least_length_mm - length_mm, length_mm - options.greatest_length_mm});
  return -kMisfitPerMm * misfit_mm - kTiltPerDeg * tilt_deg;
}

struct Candidate {
  Tunnel tunnel;
  double merit = 0;  // without the wall
};

}  // namespace

Eigen::Vector3d customary_direction(bones::BoneKind kind, const landmarks::AnatomicalAxes& axes) {
  const Eigen::Vector3d direction =
      kind == bones::BoneKind::Femur
          ? Eigen::Vector3d(0.72 * axes.lateral + 0.32 * axes.anterior + 0.62 * axes.proximal)
          : Eigen::Vector3d(-0.36 * axes.lateral + 0.47 * axes.anterior - 0.80 * axes.proximal);
  return direction.normalized();
}

Eigen::Vector3d customary_direction(bones::BoneKind kind, bones::Side side) {
  return customary_direction(kind, landmarks::scanner_axes(side));
}

AimOptions customary_aim(bones::BoneKind kind) {
  if (kind == bones::BoneKind::Femur) return {};
  // A millimetre inside of what the plan's check calls fine.
  const auto& [center, radius] = PlanNorms{}.tibial_length_mm;
  return {.least_length_mm = center - radius + 1, .greatest_length_mm = center + radius - 1};
}

Tunnel aim(const Tunnel& tunnel, const geometry::Surface& bone, const AimOptions& options) {
  constexpr int kTurns = 12;
  const Eigen::Vector3d axis = tunnel.direction.normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
  std::vector<Candidate> candidates;
  for (const double share : std::array{0.0, 0.35, 0.7, 1.0}) {
    const double tilt_deg = share * options.greatest_tilt_deg, tilt = geometry::rad_from_deg(tilt_deg);
    for (int turn = 0; turn < (share > 0 ? kTurns : 1); ++turn) {
      const double angle = 2 * geometry::kPi * turn / kTurns;
      Tunnel candidate = tunnel;
      candidate.direction =
          (std::cos(tilt) * axis + std::sin(tilt) * (std::cos(angle) * side + std::sin(angle) * up))
              .normalized();
      if (const auto length_mm = length_along(candidate, bone))
        candidates.push_back({candidate, merit_without_wall(*length_mm, tilt_deg, options)});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
  Tunnel best = tunnel;
  double best_merit = -std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    if (candidate.merit + kThickWall_mm <= best_merit) break;  // no wall could make up for it
    const double merit = candidate.merit + std::min(measure(candidate.tunnel, bone).wall_mm, kThickWall_mm);
    if (merit <= best_merit) continue;
    best_merit = merit;
    best = candidate.tunnel;
  }
  return best;
}

Tunnel first_tunnel(bones::BoneKind kind, const Eigen::Vector3d& entry_mm,
                    const landmarks::AnatomicalAxes& axes, const geometry::Surface& bone) {
  Tunnel tunnel{.bone = kind, .entry_mm = entry_mm, .direction = customary_direction(kind, axes)};
  tunnel = aim(tunnel, bone, customary_aim(kind));
  if (!length_along(tunnel, bone)) tunnel.direction = -bone.closest_point(entry_mm).normal;
  return tunnel;
}

}  // namespace arthronaut::tunnels
