// Edits of a whole label map: by threshold, parting, islands, holes, between slices, smoothing. Pure
// functions on plain arrays in the grid of the volume, for a job beside the screen; what they leave alone is
// the other labels' (segmentation/seed_growth.h has growing).
#pragma once

#include "planning/images/volume.h"
#include "planning/painting/label_change.h"

namespace arthronaut::painting {

// What holds nothing and is at least so bright gets the label.
void add_above(Labels& labels, const images::Volume& volume, float threshold, std::uint8_t label);

// Of the label's pieces (connected through faces) the largest stays. Returns how many voxels were taken away.
std::size_t keep_largest(Labels& labels, const images::Volume& grid, std::uint8_t label);

// What the label encloses on all sides, or within a slice across the patient's up (marrow of a shaft that
// runs out of the volume), becomes the label's; before that gaps of up to twice the radius are closed. Voxels
// of other labels stay.
void fill_holes(Labels& labels, const images::Volume& grid, std::uint8_t label, double closing_radius_mm = 0);

// Bones that touch: every voxel of femur or tibia goes to the bone from whose strokes it is reached without
// passing a narrower neck than from the other's (watershed over the distance to the border, Meyer 1994).
// Shells with dark marrow count as filled for that, so that strokes may lie in the marrow; nothing is filled
// by it. Strokes of surroundings take away in the same way. A piece that no stroke lies in stays as it is.
// Throws InvalidInput when fewer than two labels have strokes within the bones; the labels are then as
// before.
void part_by_strokes(Labels& labels, const images::Volume& grid, std::span<const std::uint8_t> strokes);

// As segmentation::fill_between_slices, and smooth_label, in the part of the grid that the label takes.
void fill_between(Labels& labels, const images::Volume& grid, int axis, std::uint8_t label);
void smooth(Labels& labels, const images::Volume& grid, std::uint8_t label, double radius_mm);

// Of the volume's axes the one that runs nearest to a direction in LPS.
[[nodiscard]] int axis_along(const images::Volume& grid, const Eigen::Vector3d& direction);

[[nodiscard]] double volume_ml(std::span<const std::uint8_t> labels, const images::Volume& grid,
                               std::uint8_t label);

}  // namespace arthronaut::painting
