// Which label of a map is which bone, where its segments have no names: a person says it, helped by how large
// each is and where it lies.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/images/volume.h"

namespace arthronaut::importing {

struct FoundLabel {
  std::int32_t label = 0;
  double volume_cm3 = 0;
  // Of the voxels' centres, along the patient's axes; LPS.
  Eigen::Vector3d lowest_mm = Eigen::Vector3d::Zero(), highest_mm = Eigen::Vector3d::Zero();
};

// All labels but 0, in their order; empty when the volume is no label map (images::labels_of).
[[nodiscard]] std::vector<FoundLabel> found_labels(const images::Volume& volume);

// Which are likely femur and tibia: the two largest, the upper one the femur. Of less than two nothing is
// known. To begin with, for a person to change.
[[nodiscard]] std::map<bones::BoneKind, int> likely_labels(const std::vector<FoundLabel>& labels);

}  // namespace arthronaut::importing
