#include "navigation/simulator/script.h"

#include <cmath>

#include "navigation/simulator/random.h"

namespace arthronaut::simulator {

geometry::RigidTransform tremor(std::uint64_t seed, double frame, double amplitude_mm, double amplitude_deg) {
  Random random(seed);
  geometry::Vector6d twist;
  for (int axis = 0; axis < 6; ++axis) {
    double value = 0;
    // Three slow waves of a period between 1 and 5 seconds at 30 frames a second.
    for (int wave = 0; wave < 3; ++wave) {
      const double period = random.between(30, 150), phase = random.between(0, 2 * geometry::kPi);
      value += std::sin(2 * geometry::kPi * frame / period + phase) / 3;
    }
    twist[axis] = value * (axis < 3 ? amplitude_mm : geometry::rad_from_deg(amplitude_deg));
  }
  return geometry::exp(twist);
}

geometry::RigidTransform between(const geometry::RigidTransform& a, const geometry::RigidTransform& b,
                                 double share) {
  return {a.rotation.slerp(share, b.rotation), (1 - share) * a.translation_mm + share * b.translation_mm};
}

}  // namespace arthronaut::simulator
