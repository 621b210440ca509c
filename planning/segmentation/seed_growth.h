// Bones of an MR, or of anything else, grown from a few painted strokes.
//
// Each label spreads from its strokes; a step costs more the more the grey values differ, so that the fronts
// of two labels meet at the edge between them (the shortest paths of Zhu, Kolesov, Gao, Kikinis and
// Tannenbaum, "An effective interactive medical image segmentation method using fast GrowCut", 2014). Only
// differences of neighbours count, so a field that is brighter on one side does no harm. First in voxels of
// about 1 mm, then in the volume's own along the borders alone.
//
// All functions work on plain arrays in the grid of a volume (i fastest), 0 for unlabelled: what a window
// previews and takes back is such an array.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "planning/images/volume.h"

namespace arthronaut::segmentation {

using Labels = std::vector<std::uint8_t>;

struct SeedGrowthOptions {
  std::function<void(double fraction)> on_progress = nullptr;  // may throw, to stop
};

// Every voxel gets a label that was painted; painted voxels keep theirs. Throws InvalidInput when the seeds
// are not of the volume's size or hold fewer than two labels (the background is one: paint it as well).
[[nodiscard]] Labels grow_from_seeds(const images::Volume& volume, std::span<const std::uint8_t> seeds,
                                     const SeedGrowthOptions& options = {});

// Between slices (across `axis`) in which the label is painted, its shape passes over from one to the next
// (Raya and Udupa 1990, interpolation of signed distances). Voxels of other labels stay.
void fill_between_slices(Labels& labels, const images::Volume& grid, int axis, std::uint8_t label);

// Rounds the label's border off at this radius without shrinking it as a whole; other labels keep their
// voxels, what it gives up becomes `instead`.
void smooth_label(Labels& labels, const images::Volume& grid, std::uint8_t label, double radius_mm,
                  std::uint8_t instead = 0);

}  // namespace arthronaut::segmentation
