// A CT after an operation, made from known bones: tunnels drilled where it is known, screws in them, the
// patient turned and shifted on the table.
#pragma once

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/tunnel.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut::test {

struct Drilled {
  tunnels::Tunnel tunnel = {};  // in the plan's frame, as achieved
  double from_mm = -4;          // of the entry along the direction: what is drilled away
  double to_mm = 200;
  double content_hu = 50;  // graft and fluid
  double widened_mm = 0;   // at the entry, added to the diameter; none at `widened_to_mm`
  double widened_to_mm = 20;
  double narrow_from_mm = 1e9, narrow_mm = 4.5;  // from here on a thinner bore
  double rim_hu = 0, rim_mm = 0.8;  // above 0: bone beside the tunnel is as dense as this, or denser
  double plug_diameter_mm = 0;      // above 0: a plug of bone inside
  double plug_from_mm = 2, plug_to_mm = 22, plug_hu = 450;
  double screw_diameter_mm = 0;  // above 0: a screw of metal
  double screw_from_mm = 1, screw_to_mm = 21, screw_aside_mm = 0, screw_hu = 3000;
};

// Voxels of 0.6 x 0.6 x 0.8 mm: half as fine, and made and searched in a third of the time.
[[nodiscard]] KnownCtOptions half_fine();

// The bones in the plan's frame, moved by `postop_from_plan` together.
[[nodiscard]] images::Volume postop_ct(const std::vector<geometry::TriangleMesh>& bones_in_plan,
                                       const std::vector<Drilled>& drilled,
                                       const geometry::RigidTransform& postop_from_plan,
                                       KnownCtOptions options = {});

// For KnownCtOptions::operate: marrow of `marrow_hu` becomes grainy, sigma and size of the grains as given.
[[nodiscard]] std::function<void(images::Volume&)> uneven_marrow(double marrow_hu, double sigma_hu,
                                                                 double grain_mm, std::uint64_t seed);

// A turn about a direction, and a shift.
[[nodiscard]] geometry::RigidTransform lying(double turn_deg, const Eigen::Vector3d& axis,
                                             const Eigen::Vector3d& shift_mm);

// Direction and entry moved: along and aside in the plane across the plan, and tilted towards them. The entry
// is laid on the bone's surface along the new axis.
[[nodiscard]] tunnels::Tunnel moved_tunnel(const tunnels::Tunnel& plan, const geometry::Surface& bone,
                                           const Eigen::Vector2d& shift_mm, const Eigen::Vector2d& tilt_deg);

}  // namespace arthronaut::test
