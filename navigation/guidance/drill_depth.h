// How deep the drill is. A guide does not know: the drill runs through it unseen. So depth and what remains
// are said only of a drill with a marker of its own, or of what the surgeon read at the depth stop.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "planning/tunnels/tunnel.h"

namespace arthronaut::guidance {

struct GuidanceNumbers;

// How near the drill is to leaving the bone on the far side. The predicted error counts against the drill.
enum class Breakout {
  Far,
  Near,      // less than 5 mm + sigma to the exit
  Imminent,  // less than 2 mm + sigma
  Through,   // at the exit or beyond it
};
[[nodiscard]] std::string_view to_text(Breakout breakout);
[[nodiscard]] Breakout breakout_of(double to_exit_mm, double sigma_mm);

// What is planned along the plan's axis, from its entry.
struct PlannedDepth {
  double length_mm = 0;                // to be drilled
  std::optional<double> exit_mm = {};  // where the axis leaves the bone; empty: at the end of the length
  [[nodiscard]] double exit_depth_mm() const { return exit_mm.value_or(length_mm); }
};

struct DrillDepth {
  enum class Source { Drill, DepthStop } source = Source::Drill;
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();      // bone frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // of drilling, bone frame
  double depth_mm = 0;                                   // of the tip beyond the entry, along the plan
  double remaining_mm = 0;                               // planned length - depth; negative: too deep
  double to_exit_mm = 0;                                 // along the plan; negative: through
  double lateral_mm = 0;                                 // of the tip from the plan's axis
  double sigma_mm = 0;                                   // predicted error of the depth, one sigma
  Breakout breakout = Breakout::Far;
  // Farther from the plan's axis than that, the plan's length and exit are not those of what is drilled.
  static constexpr double kMostLateral_mm = 5;
  [[nodiscard]] bool is_at_plan() const { return lateral_mm <= kMostLateral_mm; }
};

// tip_mm, direction: of the drill, in the bone's frame.
[[nodiscard]] DrillDepth drill_depth(const tunnels::Tunnel& plan, const PlannedDepth& planned,
                                     const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction,
                                     double sigma_mm, DrillDepth::Source source);

// Of a drill without a marker: beyond_guide_mm is what the surgeon reads at the depth stop, how far the
// drill's tip stands out of the guide's end; negative inside it. The guide must be seen in this moment:
// nullopt when `guide` is not valid. The reading counts as good to 0.5 mm. Throws InvalidInput when it is not
// finite or beyond 200 mm.
[[nodiscard]] std::optional<DrillDepth> depth_from_stop(const GuidanceNumbers& guide,
                                                        const tunnels::Tunnel& plan,
                                                        const PlannedDepth& planned, double beyond_guide_mm);

}  // namespace arthronaut::guidance
