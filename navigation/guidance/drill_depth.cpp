#include "navigation/guidance/drill_depth.h"

#include <algorithm>

namespace arthronaut::guidance {

std::string_view to_text(Breakout breakout) {
  switch (breakout) {
    case Breakout::Far:
      return "far from the exit";
    case Breakout::Near:
      return "near the exit";
    case Breakout::Imminent:
      return "about to break out";
    case Breakout::Through:
      return "through the far side";
  }
  return "unknown";
}

Breakout breakout_of(double to_exit_mm, double sigma_mm) {
  constexpr double kNear_mm = 5, kImminent_mm = 2;
  if (to_exit_mm <= 0) return Breakout::Through;
  if (to_exit_mm < kImminent_mm + sigma_mm) return Breakout::Imminent;
  return to_exit_mm < kNear_mm + sigma_mm ? Breakout::Near : Breakout::Far;
}

DrillDepth drill_depth(const tunnels::Tunnel& plan, double planned_length_mm, const Eigen::Vector3d& tip_mm,
                       const Eigen::Vector3d& direction, double sigma_mm) {
  const Eigen::Vector3d along = plan.direction.normalized();
  const Eigen::Vector3d from_entry = tip_mm - plan.entry_mm;
  DrillDepth drill;
  drill.tip_mm = tip_mm;
  drill.direction = direction;
  drill.depth_mm = from_entry.dot(along);
  drill.remaining_mm = drill.to_exit_mm = planned_length_mm - drill.depth_mm;
  const Eigen::Vector3d beside = from_entry - drill.depth_mm * along;
  drill.lateral_mm = drill.exit_lateral_mm = beside.norm();
  if (drill.to_exit_mm > 0) {
    constexpr double kLeastCosine = 0.1;  // what points across the plan misses its exit by far, but finitely
    const double cosine = std::max(direction.normalized().dot(along), kLeastCosine);
    const Eigen::Vector3d across = direction.normalized() - direction.normalized().dot(along) * along;
    drill.exit_lateral_mm = (beside + drill.to_exit_mm / cosine * across).norm();
  }
  drill.sigma_mm = sigma_mm;
  drill.breakout = breakout_of(drill.to_exit_mm, sigma_mm);
  return drill;
}

}  // namespace arthronaut::guidance
