// The operation on a bone of the phantom, for the tests of the simulator.
#pragma once

#include <map>
#include <utility>

#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {

// Made once in a process.
inline const phantom::PhantomKnee& phantom_knee(std::uint64_t seed, bones::Side side) {
  static std::map<std::pair<std::uint64_t, bones::Side>, phantom::PhantomKnee> knees;
  const auto [knee, is_new] = knees.try_emplace({seed, side});
  if (is_new) knee->second = phantom::make_phantom_knee({.side = side, .seed = seed});
  return knee->second;
}

inline SimulationOptions phantom_options(std::uint64_t seed = 1, bones::Side side = bones::Side::Right,
                                         bones::BoneKind bone = bones::BoneKind::Femur) {
  SimulationOptions options;
  options.knee = phantom_knee(seed, side);
  options.camera = standard_camera();
  options.tools = tools::standard_tools();
  options.bone = bone;
  options.plan = bone == bones::BoneKind::Femur ? options.knee.femoral_tunnel : options.knee.tibial_tunnel;
  options.seed = seed;
  return options;
}

}  // namespace arthronaut::simulator
