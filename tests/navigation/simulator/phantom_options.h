// The operation on a phantom femur, for the tests of the simulator.
#pragma once

#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {

inline SimulationOptions phantom_options(std::uint64_t seed = 1, bones::Side side = bones::Side::Right) {
  SimulationOptions options;
  options.knee = phantom::make_phantom_knee({.side = side, .seed = seed});
  options.camera = standard_camera();
  options.tools = tools::standard_tools();
  options.plan = options.knee.femoral_tunnel;
  options.seed = seed;
  return options;
}

}  // namespace arthronaut::simulator
