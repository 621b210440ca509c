// How rough a bone's surface is: what grew into soft tissue slice by slice, or was painted so, is ragged
// where bone is smooth.
#pragma once

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::segmentation {

// Within so much of a place bone is bowed or saddled, and little more.
inline constexpr double kPatchRadius_mm = 5;

// How far the vertices about a place lie off the surface of second order that fits them best, rms; the median
// over the bone. Bones out of CT and MR: 0.04 to 0.19 mm, with osteophytes, too; ragged ones out
// of slices of 4 mm: 0.5 to 0.7. 0 for a mesh without triangles, or whose vertices lie too far apart to tell.
[[nodiscard]] double roughness_mm(const geometry::TriangleMesh& mesh);

}  // namespace arthronaut::segmentation
