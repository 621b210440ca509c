// Where the mesh is bone and the probe touches cartilage, or the other way round: the touched surface lies off the mesh by
// one thickness over a region. The thickness is solved with the pose when the strokes hold it, else the region is left out.
#pragma once

#include <string>
#include <vector>

#include "navigation/registration/prepared_bone.h"
#include "navigation/registration/refinement.h"

namespace arthronaut::registration {

struct CoverFit {
  RefinedPose pose;
  TouchedPoints points;    // with their offsets; without the region where it was left out
  bool is_solved = false;  // else the region was left out
  bool has_bare = true;    // false: all strokes lie on the region, and nothing was done about it
  double thickness_mm = 0, sigma_mm = 0;  // one sigma, from how the likelihood falls with the thickness
  geometry::Vector6d drift_per_mm = geometry::Vector6d::Zero();  // twist of the bone frame about its origin, by thickness
  std::string assumption;  // in plain words
};

// From a pose that is right but for the thickness. The thickness is sought between -4 and 5 mm.
[[nodiscard]] CoverFit fit_cover(const PreparedBone::Data& bone, const TouchedPoints& points, const RefinedPose& pose,
                                 const CoveredRegion& region, const MarkerPrior& prior);

}  // namespace arthronaut::registration
