// Marrow is bone, whatever its grey. Inner header of segmentation.
#pragma once

#include "planning/segmentation/bone_solid.h"

namespace arthronaut::segmentation {

// Fills what the bone encloses, also where the end of the volume cuts it open: what the faces of the volume
// show within the bone, over one or several of them.
void fill_marrow(const images::Volume& volume, BoneSolid& solid);

struct ClosedMarrow {
  images::VoxelMask voxels;    // of the solid's box, that were added
  double widest_mm = 0;        // no gap is wider; 0 where there was none
  bool has_dim_walls = false;  // some of it was closed along bone that is darker than the threshold
};
// The same where the cortex has gaps: below the threshold it is thin, soft, or blurred by thick slices, and
// through a gap all of the marrow would be taken for the outside. What a ball cannot leave that has room
// within is marrow, and the gap is closed midway between inside and outside. A notch, whose mouth is as wide
// as it is, stays open, and so does a gap of more than 13 mm. What is still open then is looked at once more
// with everything from two thirds of the threshold on for a wall: of a plate thinner than a slice wide parts
// are no brighter. `others`, of the solid's box: where another bone is. The threshold: that the solid was
// made with.
[[nodiscard]] ClosedMarrow close_marrow(const images::Volume& volume, BoneSolid& solid,
                                        const images::VoxelMask& others, double threshold);

}  // namespace arthronaut::segmentation
