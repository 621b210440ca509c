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

PhantomKnee knee_of(const cases::Case& knee) {
  using bones::BoneKind;
  PhantomKnee phantom;
  phantom.side = knee.side;
  const auto take = [](auto& into, const auto& from, const auto& key) {
    if (const auto found = from.find(key); found != from.end()) into = found->second;
  };
  take(phantom.femur, knee.bones, BoneKind::Femur);
  take(phantom.tibia, knee.bones, BoneKind::Tibia);
  take(phantom.femur_landmarks, knee.landmarks, BoneKind::Femur);
  take(phantom.tibia_landmarks, knee.landmarks, BoneKind::Tibia);
  take(phantom.femoral_tunnel, knee.plan.tunnels, BoneKind::Femur);
  take(phantom.tibial_tunnel, knee.plan.tunnels, BoneKind::Tibia);
  return phantom;
}

}  // namespace arthronaut::phantom
