// How much of an expected footprint a tunnel's opening takes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/tunnels/tunnel_mouth.h"

namespace arthronaut::tunnels {

struct FootprintShare {
  double footprint_mm2 = 0, opening_mm2 = 0, shared_mm2 = 0;
  // Of the footprint that is opened; of the opening that lies in the footprint. 0 to 1.
  [[nodiscard]] double of_footprint() const { return footprint_mm2 > 0 ? shared_mm2 / footprint_mm2 : 0; }
  [[nodiscard]] double of_opening() const { return opening_mm2 > 0 ? shared_mm2 / opening_mm2 : 0; }
};

// outline_mm: a closed line on the bone, 3 points or more, the last joined to the first, as
// norms::ExpectedFootprint has it. Both are seen straight on to the mouth's face; the opening is its ellipse
// as a polygon of 360 corners of the same area. Zero for fewer points.
[[nodiscard]] FootprintShare footprint_share(const TunnelMouth& mouth,
                                             const std::vector<Eigen::Vector3d>& outline_mm);

}  // namespace arthronaut::tunnels
