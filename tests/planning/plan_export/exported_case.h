// The case that plans are exported of.
#pragma once

#include "planning/cases/plan_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::test {

inline cases::Case knee_case() {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 2});
  cases::Case contents;
  contents.name = "Knee";
  contents.side = knee.side;
  contents.bones = {{bones::BoneKind::Femur, knee.femur}, {bones::BoneKind::Tibia, knee.tibia}};
  contents.landmarks = {{bones::BoneKind::Femur, knee.femur_landmarks},
                        {bones::BoneKind::Tibia, knee.tibia_landmarks}};
  contents.plan.tunnels = {{bones::BoneKind::Femur, knee.femoral_tunnel},
                           {bones::BoneKind::Tibia, knee.tibial_tunnel}};
  cases::name_meshes(contents);
  return contents;
}

}  // namespace arthronaut::test
