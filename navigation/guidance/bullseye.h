// The bullseye: where the guide's axis goes through the plane of the planned entry, as whoever looks along
// the plan sees it. One function for the theatre's screen and for review.
#pragma once

#include "navigation/guidance/guidance.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::guidance {

struct BullseyePoint {
  // From the planned entry, seen along the plan with `across.up` up.
  double right_mm = 0, up_mm = 0;
  // How the guide leans there, the same way.
  double lean_right_deg = 0, lean_up_deg = 0;
  // The two anatomical directions of that plane; the positive sense of up_is is up.
  landmarks::AnatomicalDirection up_is = landmarks::AnatomicalDirection::Proximal;
  landmarks::AnatomicalDirection side_is = landmarks::AnatomicalDirection::Anterior;
  bool side_is_right = true;  // the positive sense of side_is points to the right
};

// Of the guide's point and direction, in the bone's frame; across: landmarks::axes_across() of the plan.
[[nodiscard]] BullseyePoint bullseye_point(const Eigen::Vector3d& guide_point_mm,
                                           const Eigen::Vector3d& guide_direction,
                                           const landmarks::PlaneAxes& across, const tunnels::Tunnel& plan);

}  // namespace arthronaut::guidance
