// The built-in knee as it is given to plan_bone.
#pragma once

#include <vector>

#include "planning/default_plan/default_plan.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::test {

// Two bones without the mark of the native footprint.
struct Knee {
  phantom::PhantomKnee made;
  geometry::Surface femur, tibia;
  explicit Knee(bones::Side side)
      : made(phantom::make_phantom_knee({.side = side, .edge_length_mm = 1.5})),
        femur(made.femur.mesh),
        tibia(made.tibia.mesh) {}
  [[nodiscard]] std::vector<default_plan::BoneInput> inputs(bool with_landmarks) const {
    auto of_femur = made.femur_landmarks, of_tibia = made.tibia_landmarks;
    of_femur.erase("native_footprint");
    of_tibia.erase("native_footprint");
    if (!with_landmarks) of_femur.clear(), of_tibia.clear();
    return {{.bone = &made.femur, .surface = &femur, .landmarks = of_femur, .states = {}},
            {.bone = &made.tibia, .surface = &tibia, .landmarks = of_tibia, .states = {}}};
  }
};

inline const Knee& knee_of(bones::Side side) {
  static const Knee right(bones::Side::Right), left(bones::Side::Left);
  return side == bones::Side::Right ? right : left;
}

}  // namespace arthronaut::test
