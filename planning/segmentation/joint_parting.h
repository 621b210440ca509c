// Parts a femur and a tibia that touch in a CT. Inner header of segmentation.
//
// The joint space says nearly where they touch. About it every voxel goes to the bone from which it is
// reached over the brighter way (a watershed by flooding; Meyer 1994), so that they part at the darkest
// voxels between them, whatever lies between bright and dark. What is below the threshold belongs to neither:
// each bone's gaps are closed and its marrow is filled once it is alone.
#pragma once

#include "planning/segmentation/bone_solid.h"
#include "planning/segmentation/joint_space.h"

namespace arthronaut::segmentation {

struct PartedBones {
  BoneSolid above, below;  // the largest piece of each side; empty where there is none
  // Over which they part further from the joint space than it is told to (a slice, 3 mm at least): there no
  // darker voxels part them, and a part of one may have gone with the other.
  double off_joint_mm2 = 0;
};

// `whole` holds both; of it only what reaches the threshold is parted.
[[nodiscard]] PartedBones part_bones(const images::Volume& volume, const BoneSolid& whole,
                                     const JointSpace& joint, double threshold, double closing_radius_mm);

}  // namespace arthronaut::segmentation
