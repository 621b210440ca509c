// Over how much of its depth a tunnel breaks out of the bone.
#pragma once

#include <vector>

#include "planning/geometry/surface.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

// A piece of a tunnel, along its axis from the entry on; may begin a little before the entry or end beyond
// the exit, in a slanting rim.
struct DepthRange {
  double from_mm = 0, to_mm = 0;
};

// Where the tunnel's side lies outside the bone, on whichever side of it, ascending; pieces less than 1 mm
// apart are one. Empty where `measured`, which is of this tunnel and bone, has a wall or misses. Lips of
// mouths do not count, as in tunnel_wall.h. Some milliseconds.
[[nodiscard]] std::vector<DepthRange> breaches_of(const Tunnel& tunnel, const TunnelGeometry& measured,
                                                  const geometry::Surface& bone);

}  // namespace arthronaut::tunnels
