// The operation on a bone of the phantom, for the tests of the simulator.
#pragma once

#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {

inline SimulationOptions phantom_options(std::uint64_t seed = 1, bones::Side side = bones::Side::Right,
                                         bones::BoneKind bone = bones::BoneKind::Femur) {
  SimulationOptions options;
  options.knee = phantom::make_phantom_knee({.side = side, .seed = seed});
  options.camera = standard_camera();
  options.tools = tools::standard_tools();
  options.bone = bone;
  options.plan = bone == bones::BoneKind::Femur ? options.knee.femoral_tunnel : options.knee.tibial_tunnel;
  options.seed = seed;
  return options;
}

}  // namespace arthronaut::simulator
