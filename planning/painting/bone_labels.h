// Bones that a case has, as labels in the grid of its images: what a painting of them begins with.
#pragma once

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"
#include "planning/painting/label_change.h"

namespace arthronaut::painting {

// The voxels whose centres lie within the mesh get the label, those of another label, too. The mesh is in
// LPS, closed; where it winds around a place more than once that is inside. Nothing for a mesh beside the
// volume. `labels` is of the grid's size.
void add_bone(Labels& labels, const images::Volume& grid, const geometry::TriangleMesh& mesh,
              std::uint8_t label);

// A number that another distribution of the label has not, but by a chance of one in 2^64: tells whether a
// bone was changed without a second copy of all its voxels. Equal for equal voxels of this label, whatever
// the others are.
[[nodiscard]] std::uint64_t digest_of(std::span<const std::uint8_t> labels, std::uint8_t label);

}  // namespace arthronaut::painting
