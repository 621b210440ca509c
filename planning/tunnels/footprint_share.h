// How much of an expected footprint a tunnel opens.
#pragma once

#include <Eigen/Core>

#include "planning/geometry/surface_patch.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

struct FootprintShare {
  // On the bone: what is opened has no other area when the drill comes from elsewhere.
  double footprint_mm2 = 0, shared_mm2 = 0;
  double of_opening = 0;  // of the drill's circle, along its axis, what passes through the footprint: 0 to 1
  // Of the footprint that is opened: 0 to 1.
  [[nodiscard]] double of_footprint() const { return footprint_mm2 > 0 ? shared_mm2 / footprint_mm2 : 0; }
};

// The footprint within a cylinder about the tunnel's axis; its circle is a polygon of 90 corners of the same
// area. footprint: as geometry::patch_within() gives it of the expected outline.
[[nodiscard]] FootprintShare footprint_share(const Tunnel& tunnel, const geometry::SurfacePatch& footprint);

}  // namespace arthronaut::tunnels
