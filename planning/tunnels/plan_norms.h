// The numbers that a plan is compared with. Means of studies and customs, each with its source; they are no
// limits of safety, every one can be changed, and the surgeon decides.
#pragma once

#include "planning/landmarks/landmarks.h"

namespace arthronaut::tunnels {

// A study's mean and how far from it still counts as fine.
struct NormRange {
  double center, radius;
};

struct PlanNorms {
  // "Customary" limits: not defined in the literature (see 10.1007/s10195-017-0448-9 for the femoral length).
  double short_femoral_tunnel_mm = 30, too_short_femoral_tunnel_mm = 25;
  // Hodel 2021 (10.1186/s40634-021-00364-9): 29.6 to 50.5 mm. A longer one runs across the bone.
  double long_femoral_tunnel_mm = 50.5;
  NormRange tibial_length_mm{40, 5};
  double thin_wall_mm = 2, breaking_wall_mm = 1;
  double small_diameter_mm = 8, wide_diameter_mm = 11;
  // Of the opening: below this angle between tunnel and surface the mouth is a groove more than twice as long
  // as wide. A choice.
  double grazing_mouth_deg = 30;
  // Review of 13 studies (Arthroscopy 2016): 28.4 +- 5.1, 35.7 +- 6.9 %.
  NormRange femur_deep_shallow_percent{28.4, 5.1}, femur_high_low_percent{35.7, 6.9};
  // Cho 2017: 40.9 % (38.0 to 45.0). 10.1177/23259671231208678: 46.7 +- 2.0 %.
  NormRange tibia_anterior_posterior_percent{41.5, 3.5}, tibia_medial_lateral_percent{46.7, 4.0};
  // Howell: 65 to 70 deg in the coronal plane is advised, 75 and more costs flexion.
  NormRange tibial_coronal_deg{67.5, 2.5};
  double too_steep_tibial_coronal_deg = 75;
  // Basdekis: 4.0, 9.7 and 13.2 mm from the exit to the posterior cortex for drilling at 90, 110 and 130 deg
  // of flexion.
  double near_posterior_cortex_mm = 4.0;
  // Howell 1995: the whole opening behind the roof's slope, in extension.
  double least_roof_clearance_mm = 0;
  // Customary: a change of 2 to 3 mm over flexion is called isometric.
  double isometric_change_mm = 3;
  // A choice: further from where the bone's shape puts it a landmark is to be looked at once more.
  double far_landmark_mm = landmarks::kFarFromShape_mm;
  // Customary for two bundles.
  double thin_bone_between_tunnels_mm = 2;
};

}  // namespace arthronaut::tunnels
