// How deep the drill is. A guide does not know: the drill runs through it unseen. So depth and what remains
// are said only of a drill with a marker of its own; nothing is reckoned from what the surgeon reads at the
// depth stop.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "planning/geometry/quantile.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::guidance {

// How near the drill is to leaving the bone on the far side. The predicted error counts against the drill.
enum class Breakout {
  Far,
  Near,      // less than 5 mm + sigma to the exit
  Imminent,  // less than 2 mm + sigma
  Through,   // at the exit or beyond it
};
[[nodiscard]] std::string_view to_text(Breakout breakout);
[[nodiscard]] Breakout breakout_of(double to_exit_mm, double sigma_mm);

struct DrillDepth {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();      // bone frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // of drilling, bone frame
  double depth_mm = 0;                                   // of the tip beyond the entry, along the plan
  double remaining_mm = 0;                               // planned length - depth; negative: too deep
  double to_exit_mm = 0;  // the same: a plan's length ends where its axis leaves the bone
  double lateral_mm = 0;  // of the tip from the plan's axis; not a number: not known
  // Of the drill's axis from the plan's where that leaves the bone, as the drill points now; of a tip that is
  // there or beyond as lateral_mm. Not a number: not known, in older records.
  double exit_lateral_mm = 0;
  // Predicted, one sigma: of the depth; of where the drill's axis crosses the plane through the entry across
  // the plan, and of its direction, as GuidanceNumbers says them of the guide. Not a number: not known. What
  // was recorded before 2026-11-27 holds the depth's alone, and nothing of where the drill was.
  double sigma_mm = 0;
  double sigma_offset_mm = geometry::kNotKnown, sigma_angle_deg = geometry::kNotKnown;
  Breakout breakout = Breakout::Far;
  // Farther from the plan's axis than that, or on the way there, the plan's length and exit are not those of
  // what is drilled. Where the tip's is not known, neither holds.
  static constexpr double kMostLateral_mm = 5;
  [[nodiscard]] bool is_at_plan() const { return lateral_mm <= kMostLateral_mm && !is_beside_plan(); }
  [[nodiscard]] bool is_beside_plan() const {
    return lateral_mm > kMostLateral_mm || exit_lateral_mm > kMostLateral_mm;
  }
};

// tip_mm, direction: of the drill, in the bone's frame. sigma_mm: of the depth.
[[nodiscard]] DrillDepth drill_depth(const tunnels::Tunnel& plan, double planned_length_mm,
                                     const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction,
                                     double sigma_mm);

}  // namespace arthronaut::guidance
