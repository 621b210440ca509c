// Directions that a drill can follow from an entry, in the bone's own anatomical axes. Inner header of
// default_plan.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/default_plan/default_plan.h"
#include "planning/graft/flexion_axis.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::default_plan {

// Where the condyles and the plateau are, as far as aims need it.
struct Joint {
  landmarks::AnatomicalAxes axes;
  graft::FlexionAxis hinge;                // femur: about which the knee flexes
  tunnels::PlanSurroundings surroundings;  // what the plan's checks ask; with its axes

  // Where nobody has seen bone: of such a tunnel neither length nor exit can be checked.
  [[nodiscard]] bool leaves_unseen(const tunnels::TunnelGeometry& measured) const {
    return measured.enters_bone && !surroundings.unseen.reached(measured.exit_mm).empty();
  }
};

// Femur: the drill comes from the accessory anteromedial portal (tunnels::anteromedial_portal), which is
// turned with the tibia by the flexion. Tibia: along the guide, 55 degrees to the plateau in the sagittal
// view and 67.5 degrees in the coronal one (PlanNorms). About either, flexion (100 to 130 degrees) and
// portal, or the guide's two angles (-15 to +20 and -10 to +5 degrees), are varied, and of the directions
// that leave on the right face (femur: lateral, tibia: anteromedial) those count that fail the fewest of the
// plan's own checks (check_plan), of these the ones nearest to what was asked; a number within 0.5 mm or
// degrees of its limit costs as well, and to leave unseen as much as failing length and exit. Beside another
// tunnel of the bone (null: there is none) the bone between them counts twice as much as any other number,
// and the guide's angles are varied further. Directions that are about as good count, too, the nearer to the
// best the more, so that the axis does not leap with what another scan shows otherwise. nullopt when none
// leaves there, and when options.stop asks for it.
[[nodiscard]] std::optional<tunnels::Tunnel> aim(const tunnels::Tunnel& at_entry,
                                                 const geometry::Surface& surface, const Joint& joint,
                                                 const Options& options,
                                                 const tunnels::Tunnel* beside = nullptr);

}  // namespace arthronaut::default_plan
