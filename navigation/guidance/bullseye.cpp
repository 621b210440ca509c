#include "navigation/guidance/bullseye.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::guidance {

BullseyePoint bullseye_point(const Eigen::Vector3d& guide_point_mm, const Eigen::Vector3d& guide_direction,
                             const landmarks::PlaneAxes& across, const tunnels::Tunnel& plan) {
  const bool side_is_right = plan.direction.cross(across.up).dot(across.side) > 0;
  const Eigen::Vector3d right = side_is_right ? across.side : Eigen::Vector3d(-across.side);
  const Eigen::Vector3d off_mm = crossing_of(guide_point_mm, guide_direction, plan) - plan.entry_mm;
  const double advance = guide_direction.dot(plan.direction.normalized());
  const auto lean_deg = [&](const Eigen::Vector3d& towards) {
    return geometry::deg_from_rad(std::atan2(guide_direction.dot(towards), advance));
  };
  return {off_mm.dot(right), off_mm.dot(across.up), lean_deg(right), lean_deg(across.up),
          across.up_is,      across.side_is,        side_is_right};
}

}  // namespace arthronaut::guidance
