// The fibula where it touches the tibia. Inner header of segmentation.
#pragma once

#include <vector>

#include "planning/segmentation/bone_solid.h"

namespace arthronaut::segmentation {

struct PartedFibula {
  enum class Outcome {
    NoneSeen,  // nowhere below the plateau does the solid fall into a shaft and a slender one beside it
    Parted,
    NotParted,  // it is there, but what was cut off with it is no fibula: the solid is as it was
  } outcome = Outcome::NoneSeen;
  std::vector<Eigen::Vector3d> taken_mm;  // LPS
};

// Below the joint of the two bones the tibia's solid falls into two in every slice. From there both are
// flooded upwards, marrow before cortex, so that they meet in the plates of bone between them however broad
// these touch. The solid becomes the tibia alone.
[[nodiscard]] PartedFibula part_fibula(const images::Volume& volume, BoneSolid& tibia);

}  // namespace arthronaut::segmentation
