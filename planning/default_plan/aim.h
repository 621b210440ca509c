// Directions that a drill can follow from an entry, in the bone's own anatomical axes. Inner header of
// default_plan.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/default_plan/default_plan.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::default_plan {

// Where the condyles and the plateau are, as far as aims need it.
struct Joint {
  landmarks::AnatomicalAxes axes;
  // Femur: half way between the condyles' centres, about which the knee flexes.
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double scale = 1;  // of the bone against an average one
};

// Femur: the drill comes from the accessory anteromedial portal, 24 mm medial of the middle, 35 mm in front
// of and 15 mm below the flexion axis in the tibia's axes, about which the tibia is turned by the flexion.
// Tibia: along the guide, 55 degrees to the plateau in the sagittal view and 67.5 degrees in the coronal one
// (Howell). About either, flexion (100 to 130 degrees) and portal, or the guide's two angles (+-10 degrees),
// are varied, and the direction nearest to the asked one is taken that leaves on the right face (femur:
// lateral, tibia: anteromedial), has a length of 30 to 45 mm in the femur, 32 to 55 mm in the tibia, and a
// wall of 2 mm; less wall, then less length, where none has. Beside another tunnel of the bone (null: there
// is none) 2 mm of bone between them are worth twice as much as the wall, and the guide's angles are varied
// further. Directions that are about as good count, too, the nearer to the best the more, so that
// the axis does not leap with what another scan shows otherwise. nullopt when none leaves there, and when
// options.stop asks for it.
[[nodiscard]] std::optional<tunnels::Tunnel> aim(const tunnels::Tunnel& at_entry,
                                                 const geometry::Surface& surface, const Joint& joint,
                                                 const Options& options,
                                                 const tunnels::Tunnel* beside = nullptr);

}  // namespace arthronaut::default_plan
