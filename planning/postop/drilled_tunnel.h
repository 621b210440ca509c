// The tunnel that was drilled in a bone, found in a post-operative CT and measured. Inner header of postop.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "planning/postop/drilled_mouth.h"
#include "planning/postop/goes_on.h"
#include "planning/postop/tunnel_fit.h"
#include "planning/tunnels/tunnel_quantity.h"

namespace arthronaut::postop {

// Why it is not reliable, and what of it: what is told of other quantities stands.
struct Doubt {
  std::string reason;
  tunnels::Quantities about = tunnels::all_quantities();
};

struct DrilledTunnel {
  bool is_found = false;       // false: the numbers are meaningless
  tunnels::Tunnel tunnel;      // in the plan's frame; the entry where the axis enters the plan's bone
  double length_mm = 0;        // within the bone, to where it comes out, ends or goes on as a thinner bore
  double length_sigma_mm = 0;  // one sigma; infinite where it is not known
  bool comes_out = false;
  bool end_is_seen = true;  // false: the length is as far as the images or the bone reach
  double beyond_mm = 0;     // diameter of the thinner bore beyond; 0: none is seen
  double entry_sigma_mm = 0, direction_sigma_rad = 0, diameter_sigma_mm = 0;
  double entry_per_across = 1;     // what an axis is off across itself its entry is, times this
  double seen_share = 0;           // of its wall
  double metal_share = 0;          // of what is inside it
  std::vector<Stretch> stretches;  // from the entry to the end
  std::vector<Doubt> doubts = {{"no tunnel was looked for"}};
};

// `bone`: the plan's, before the operation. `others`: what else was planned in it; a tunnel that lies nearer
// to one of those is taken for it. `goes_on`: told before each bore that is measured; where it ended the
// search nothing was found.
[[nodiscard]] DrilledTunnel find_drilled(const images::Volume& postop,
                                         const geometry::RigidTransform& postop_from_plan,
                                         const geometry::Surface& bone, const tunnels::Tunnel& plan,
                                         std::span<const tunnels::Tunnel> others = {},
                                         const GoesOn& goes_on = {});

}  // namespace arthronaut::postop
