#include "navigation/guidance/drill_depth.h"

#include <algorithm>
#include <cmath>

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
  if (drill.is_beside_plan()) drill.to_exit_mm = geometry::kNotKnown;
  drill.breakout = breakout_of(drill.to_exit_mm, sigma_mm);
  return drill;
}

std::optional<double> to_exit_along(const geometry::Surface& bone, const Eigen::Vector3d& tip_mm,
                                    const Eigen::Vector3d& direction) {
  constexpr double kLeastBone_mm = 3, kLeastDrilled_mm = 10, kStep_mm = 1e-3;
  const Eigen::Vector3d along = direction.normalized();
  const auto leaves = [&](const std::optional<geometry::RayHit>& hit) {
    return hit && hit->normal.dot(along) > 0;
  };
  auto ahead = bone.first_hit(tip_mm, along);
  double passed_mm = 0;  // from the tip to where `ahead` was looked for
  const auto go_on = [&] {
    passed_mm += ahead->distance_mm + kStep_mm;
    ahead = bone.first_hit(tip_mm + passed_mm * along, along);
  };
  const auto behind = bone.first_hit(tip_mm, -along);
  if (leaves(ahead)) {
    if (!behind || ahead->distance_mm + behind->distance_mm >= kLeastBone_mm) return ahead->distance_mm;
    go_on();
  } else if (leaves(behind)) {
    const auto begins = bone.first_hit(behind->point_mm - kStep_mm * along, -along);
    if (!begins || begins->distance_mm >= kLeastDrilled_mm) return -behind->distance_mm;
  }
  while (ahead) {
    const double begins_mm = passed_mm + ahead->distance_mm;
    go_on();
    if (!leaves(ahead)) break;  // no closed surface: nothing is known of it
    if (passed_mm + ahead->distance_mm - begins_mm >= kLeastBone_mm) return passed_mm + ahead->distance_mm;
    go_on();
  }
  return std::nullopt;
}

double from_tunnel_mm(const DrillDepth& drill) {
  return std::hypot(drill.lateral_mm, std::min(drill.depth_mm, 0.0));
}

void hold_against(const geometry::Surface& bone, DrillDepth& drill) {
  if (const auto own_mm = to_exit_along(bone, drill.tip_mm, drill.direction))
    drill.to_exit_mm = drill.is_beside_plan() ? *own_mm : std::min(*own_mm, drill.remaining_mm);
  drill.breakout = breakout_of(drill.to_exit_mm, drill.sigma_mm);
}

}  // namespace arthronaut::guidance
