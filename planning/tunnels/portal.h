// The directions in which a femoral tunnel can be drilled from one entry: through a portal in the skin in
// front of the flexed knee, or from outside in.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "planning/graft/flexion_axis.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::tunnels {

// A hole in the skin that stays with the tibia when the knee bends.
struct Portal {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();             // of the knee as imaged, LPS
  double radius_mm = 5;                                        // how far skin gives way about it
  double least_flexion_deg = 100, greatest_flexion_deg = 130;  // in which it is drilled
};
// The accessory anteromedial one: of an average knee 24 mm medial of, 35 mm in front of and 15 mm below the
// middle of the flexion axis, in the femur's axes with the knee extended; of another as its condyles stand
// apart. A custom; where the surgeon makes it is his.
[[nodiscard]] Portal anteromedial_portal(const graft::FlexionAxis& axis,
                                         const landmarks::AnatomicalAxes& axes);

struct PortalAim {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit, of drilling
  double flexion_deg = 0;
  // No femur beside the drill from the portal to 3 mm and the drill's radius before the entry, where it meets
  // the bone at a slant.
  bool is_clear = false;
};
// The portal's middle and 8 points of its rim, at every 5 deg of flexion. entry_mm: on the femur.
[[nodiscard]] std::vector<PortalAim> portal_aims(const Eigen::Vector3d& entry_mm, double diameter_mm,
                                                 const Portal& portal, const graft::FlexionAxis& axis,
                                                 const geometry::Surface& femur);

// Between a direction and the nearest clear aim, deg: 0 to 3 means that the portal allows it (the aims stand
// that far apart). 180 where none is clear.
[[nodiscard]] double off_portal_deg(const Eigen::Vector3d& direction, const std::vector<PortalAim>& aims);

// From outside in: of the directions within 75 deg of lateral, every 7.5 deg, those whose tunnel leaves
// through the lateral cortex, not on the lateral epicondyle, is of a length that the norms call fine and does
// not break out. Slow, since each is measured: stops early, with those so far, when is_cancelled says so.
// Empty where the bone's axes are not known.
[[nodiscard]] std::vector<Eigen::Vector3d> outside_in_aims(const Tunnel& at_entry,
                                                           const geometry::Surface& femur,
                                                           const PlanSurroundings& surroundings,
                                                           const PlanNorms& norms = {},
                                                           const std::function<bool()>& is_cancelled = {});

}  // namespace arthronaut::tunnels
