// The cortex of a bone in an MR. Cortical bone gives no signal: about bright marrow lies a dark rim that
// belongs to the bone, and what is grown or painted often ends at the marrow, half a millimetre to two too
// small. The rim is told by profiles across the border: from inside the grey falls to its least and rises
// again; half-way up that rise the bone ends. Where tendon or ligament, dark themselves, are attached no rise
// is seen: there the rim is as thick as elsewhere on the bone.
//
// Nothing is found in a CT, in which fat is the dark that lies about bone, whether the file says that it is
// one or holds air as a CT has it.
#pragma once

#include <cstdint>
#include <span>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"
#include "planning/segmentation/seed_growth.h"

namespace arthronaut::segmentation {

struct DarkRim {
  double share = 0;         // of the border, in [0, 1], outside of which a dark rim is seen
  double thickness_mm = 0;  // from the border to the rim's outer edge, median where it is seen
  // Enough of it to be cortex that was left out: share >= 0.3 and thickness_mm >= 0.3.
  [[nodiscard]] bool is_seen() const { return share >= 0.3 && thickness_mm >= 0.3; }
};

// The label's rim is taken in, from voxels that hold none of the `others` (labels of other bones) and no
// stroke
// (`seeds`, 0 where nothing is painted; empty: nothing is). Where none is seen the labels stay as they are.
// Throws InvalidInput when labels or seeds are not of the volume's size.
DarkRim take_in_dark_rim(Labels& labels, const images::Volume& volume, std::uint8_t label,
                         std::span<const std::uint8_t> others, std::span<const std::uint8_t> seeds);

// What lies outside of a closed surface that looks outwards (LPS, mm). A few milliseconds.
[[nodiscard]] DarkRim rim_outside(const geometry::TriangleMesh& surface, const images::Volume& volume);

}  // namespace arthronaut::segmentation
