// What calibrate_rig() is measured against: what one would do without it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "navigation/tools/rig_calibration.h"

namespace arthronaut::test {

// The mean of the poses relative to the reference over the frames in which both are seen (mean of
// translations, chordal mean of rotations), in the order of the options. Empty for a marker never seen with
// it.
[[nodiscard]] std::vector<std::optional<geometry::RigidTransform>> mean_relative_poses(
    std::span<const tools::RigSighting> sightings, const tools::RigOptions& options);

}  // namespace arthronaut::test
