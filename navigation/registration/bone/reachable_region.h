// The part of a bone that a probe can have touched, by the plan: near the planned tunnel's entry, and open to
// the side that the entry looks to. Strokes are looked for there first; whoever scratched elsewhere is found
// by the searches that follow.
#pragma once

#include <vector>

#include "navigation/registration/bone/surface_index.h"

namespace arthronaut::registration {

// One for each sample of bone.pairs. Within 40 mm of the entry, facing a direction less than 80 degrees from
// the outward normal there along which nothing of the bone stands in the way for 40 mm. Empty when the entry
// is not on the bone.
[[nodiscard]] std::vector<bool> find_reachable_samples(const SurfaceIndex::Data& bone,
                                                       const Eigen::Vector3d& entry_in_bone_mm);

}  // namespace arthronaut::registration
