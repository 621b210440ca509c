// Where to aim a tunnel when all that is known is its entry: the customary direction, turned a little to fit
// the bone.
#pragma once

#include "planning/bones/bone.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

// Unit, in the bone's frame, the knee in extension. Femur: outwards, forwards and up, as drilled through the
// anteromedial portal. Tibia: down to the anteromedial face, 55 degrees steep. Customs of the field, no
// norms.
[[nodiscard]] Eigen::Vector3d customary_direction(bones::BoneKind kind,
                                                  const landmarks::AnatomicalAxes& axes);
// The same along the scanner's axes, for a bone that lies straight in them.
[[nodiscard]] Eigen::Vector3d customary_direction(bones::BoneKind kind, bones::Side side);

struct AimOptions {
  double least_length_mm = 32, greatest_length_mm = 38;  // inside bone
  double greatest_tilt_deg = 14;                         // against the direction aimed at first
};
// 32 to 38 mm in the femur, 36 to 44 mm in the tibia: inside of what plan_checks.h calls fine.
[[nodiscard]] AimOptions customary_aim(bones::BoneKind kind);

// Of the directions within greatest_tilt_deg of the tunnel's own, that with the thickest wall among tunnels
// of a fitting length, little tilt preferred; the length nearest to fitting where none fits. The tunnel
// itself where none enters.
[[nodiscard]] Tunnel aim(const Tunnel& tunnel, const geometry::Surface& bone, const AimOptions& options);

// A first tunnel where somebody pointed at the bone: in the customary direction of the bone's own axes,
// fitted to it. Never straight against the surface, which from the plateau is down the shaft. Against the
// surface after all where the customary direction leads out of the bone.
[[nodiscard]] Tunnel first_tunnel(bones::BoneKind kind, const Eigen::Vector3d& entry_mm,
                                  const landmarks::AnatomicalAxes& axes, const geometry::Surface& bone);

}  // namespace arthronaut::tunnels
