// What the surgeon should touch next, and how far a registration is from being confirmed.
#pragma once

#include "navigation/registration/confidence.h"
#include "navigation/registration/online_registration.h"

namespace arthronaut::registration {

// The parts of the bone within reach of what was touched, each with what a stroke of 15 mm there would do for the
// predicted error at the target.
[[nodiscard]] std::vector<BonePatch> find_patches(const PreparedBone::Data& bone, const RefinedPose& pose,
                                                  const TouchedPoints& points, const MarkerPrior& prior,
                                                  const Eigen::Vector3d& target_mm);

// "the front and outer side": where a patch faces and lies in the words of the knee; LPS.
[[nodiscard]] std::string describe_place(const BonePatch& patch, const Eigen::Vector3d& touched_centroid_in_bone_mm);

}  // namespace arthronaut::registration
