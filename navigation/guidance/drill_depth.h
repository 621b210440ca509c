// How deep the drill is. A guide does not know: the drill runs through it unseen. So depth and what remains
// are said only of a drill with a marker of its own; nothing is reckoned from what the surgeon reads at the
// depth stop.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "planning/geometry/quantile.h"
#include "planning/geometry/surface.h"
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
  std::optional<int> marker_id;                          // the tool's; empty: older records do not say whose
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();      // bone frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // of drilling, bone frame
  double depth_mm = 0;                                   // of the tip beyond the entry, along the plan
  double remaining_mm = 0;                               // planned length - depth; negative: too deep
  // To where the drill leaves the bone: along its own axis, and where it is at the plan no later than its
  // length ends. Not positive: it has left it. Where the bone is not known, what remains, and of a drill
  // beside the plan not a number.
  double to_exit_mm = 0;
  double lateral_mm = 0;  // of the tip from the plan's axis; not a number: not known
  // Of the drill's axis from the plan's where that leaves the bone, as the drill points now; of a tip that is
  // there or beyond as lateral_mm. Not a number: not known, in older records.
  double exit_lateral_mm = 0;
  // Predicted, one sigma: of the depth, or of the tip along the drill's axis where that is more; of where the
  // drill's axis crosses the plane through the entry across the plan, and of its direction, as
  // GuidanceNumbers says them of the guide. Not a number: not known. What was recorded before 2026-11-27
  // holds the depth's alone, and nothing of where the drill was.
  double sigma_mm = 0;
  double sigma_offset_mm = geometry::kNotKnown, sigma_angle_deg = geometry::kNotKnown;
  Breakout breakout = Breakout::Far;
  // Farther from the plan's axis than that, or on the way there, the plan's length is not that of what is
  // drilled. Where the tip's is not known, neither holds.
  static constexpr double kMostLateral_mm = 5;
  [[nodiscard]] bool is_at_plan() const { return lateral_mm <= kMostLateral_mm && !is_beside_plan(); }
  [[nodiscard]] bool is_beside_plan() const {
    return lateral_mm > kMostLateral_mm || exit_lateral_mm > kMostLateral_mm;
  }
};

// Along the axis from the tip to where it leaves the bone, on the far side of what it is in, or of the next
// that it would go into; negative: how far behind the tip it did. Empty: no bone lies there. What is less
// than 3 mm thick is the roughness of the surface, and what is less than 10 mm thick nothing that a drill has
// gone through: it may be grazed by a pose that is a little off. bone: closed, oriented outwards.
[[nodiscard]] std::optional<double> to_exit_along(const geometry::Surface& bone,
                                                  const Eigen::Vector3d& tip_mm,
                                                  const Eigen::Vector3d& direction);

// By the plan alone. tip_mm, direction: of the drill, in the bone's frame. sigma_mm: of the depth.
[[nodiscard]] DrillDepth drill_depth(const tunnels::Tunnel& plan, double planned_length_mm,
                                     const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction,
                                     double sigma_mm);
// Of its tip from the planned tunnel's axis, from the entry on: one that is too deep is no farther off.
[[nodiscard]] double from_tunnel_mm(const DrillDepth& drill);
// Exit and warning by the bone that the drill is in, wherever the plan is.
void hold_against(const geometry::Surface& bone, DrillDepth& drill);

}  // namespace arthronaut::guidance
