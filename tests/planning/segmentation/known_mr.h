// An MR made from a label map, so that its segmentation is known: a grey value for each label, partial
// volume, a field that is brighter on one side, noise. And the strokes that a person would paint.
#pragma once

#include <cstdint>
#include <vector>

#include "planning/images/volume.h"

namespace arthronaut::test {

// Grey values run from about 100 to 900; the field makes one end 1.4 times as bright as the other.
// Labels 5 and 6 where femur and tibia of the built-in knee cover more than half of a voxel, in sagittal
// slices.
[[nodiscard]] images::Volume known_labels();

[[nodiscard]] images::Volume known_mr(const images::Volume& labels, double noise, std::uint64_t seed = 1);

// Ten strokes, a voxel or two thick: three well within each of the two bones, on slices across the axis of
// the thickest slices, and four in what surrounds them, near the bones and far. The background gets label 1.
inline constexpr std::uint8_t kBackground = 1;
[[nodiscard]] std::vector<std::uint8_t> strokes(const images::Volume& labels, const std::vector<int>& bones);

}  // namespace arthronaut::test
