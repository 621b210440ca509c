// The intercondylar notch, seen from inside: its walls, its roof and Blumensaat's line. Inner header of
// landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/geometry/surface.h"
#include "planning/landmarks/condyles.h"
#include "planning/landmarks/propose.h"

namespace arthronaut::landmarks {

// As one convention lays it. Bone frame.
struct BlumensaatLine {
  Eigen::Vector3d anterior_mm, posterior_mm;  // its ends
  // In the lateral view: along the line towards the front, and out of the notch into the bone. At right
  // angles.
  Eigen::Vector3d forward, into_bone;
};

struct Notch {
  BlumensaatLine flat, ends;  // by RoofConvention
  Eigen::Vector3d roof;       // forward along the best straight line through the roof
  Eigen::Vector3d apex_mm;    // of the roof's ridge, halfway
  RoofShape shape = RoofShape::Straight;
  double hill_mm = 0;
  double cost =
      0;  // of the roof's misfit, to compare what was found from different sides; the less the better
};

// Rays from inside the notch onto its roof: of each cross section of the roof the deepest point is what the
// lateral view shows as its outline. The roof ends where three straight pieces that follow the outline best
// meet: the back of the shaft, the roof, the groove of the kneecap. Roofs are bent like an S, so that an end
// is not where the outline leaves the line by so much, but where it turns for good. The line's direction is
// found anew until it stays. nullopt where between the condyles no such roof is.
[[nodiscard]] std::optional<Notch> find_notch(const geometry::Surface& femur, const Condyles& condyles);

}  // namespace arthronaut::landmarks
