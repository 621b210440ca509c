#include "navigation/guidance/drill_depth.h"

#include <cmath>

#include "navigation/guidance/guidance.h"
#include "planning/geometry/error.h"

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

DrillDepth drill_depth(const tunnels::Tunnel& plan, const PlannedDepth& planned,
                       const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double sigma_mm,
                       DrillDepth::Source source) {
  const Eigen::Vector3d along = plan.direction.normalized();
  const Eigen::Vector3d from_entry = tip_mm - plan.entry_mm;
  DrillDepth drill;
  drill.source = source;
  drill.tip_mm = tip_mm;
  drill.direction = direction;
  drill.depth_mm = from_entry.dot(along);
  drill.remaining_mm = planned.length_mm - drill.depth_mm;
  drill.to_exit_mm = planned.exit_depth_mm() - drill.depth_mm;
  drill.lateral_mm = (from_entry - drill.depth_mm * along).norm();
  drill.sigma_mm = sigma_mm;
  drill.breakout = breakout_of(drill.to_exit_mm, sigma_mm);
  return drill;
}

std::optional<DrillDepth> depth_from_stop(const GuidanceNumbers& guide, const tunnels::Tunnel& plan,
                                          const PlannedDepth& planned, double beyond_guide_mm) {
  constexpr double kMost_mm = 200, kReadingSigma_mm = 0.5;
  if (!(std::abs(beyond_guide_mm) <= kMost_mm))
    throw InvalidInput("the depth stop must read a number of mm between -200 and 200");
  if (!guide.is_valid()) return std::nullopt;
  // The offset's error is that of two coordinates; along the plan there is one.
  const double sigma_mm = std::hypot(kReadingSigma_mm, guide.sigma_offset_mm / std::sqrt(2.0));
  return drill_depth(plan, planned, guide.guide_point_mm + beyond_guide_mm * guide.guide_direction,
                     guide.guide_direction, sigma_mm, DrillDepth::Source::DepthStop);
}

}  // namespace arthronaut::guidance
