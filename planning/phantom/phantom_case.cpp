#include "planning/phantom/phantom_case.h"

#include "planning/files/utc_clock.h"

namespace arthronaut::phantom {

cases::Case case_of(const PhantomKnee& knee, const std::string& name) {
  using bones::BoneKind;
  return {
      .name = name,
      .side = knee.side,
      .created_utc = files::utc_now(),
      .bones = {{BoneKind::Femur, knee.femur}, {BoneKind::Tibia, knee.tibia}},
      .landmarks = {{BoneKind::Femur, knee.femur_landmarks}, {BoneKind::Tibia, knee.tibia_landmarks}},
      .plan = {.tunnels = {{BoneKind::Femur, knee.femoral_tunnel}, {BoneKind::Tibia, knee.tibial_tunnel}}}};
}

}  // namespace arthronaut::phantom
