// How wide a tunnel can be planned, by key, by command and by default: from a thin drill to more than any
// graft asks for. What is customary within it the plan's checks say (plan_norms.h).
#pragma once

#include "planning/norms/insertion_norms.h"

namespace arthronaut::tunnels {

inline constexpr double kLeastDiameter_mm = 3, kGreatestDiameter_mm = 15;

// Customary, of grafts from hamstring tendons: 9 mm for the whole ligament, 7 mm for AM and 6 mm for PL.
[[nodiscard]] constexpr double usual_diameter_mm(norms::Bundle bundle) {
  return bundle == norms::Bundle::Anteromedial ? 7.0 : bundle == norms::Bundle::Posterolateral ? 6.0 : 9.0;
}

}  // namespace arthronaut::tunnels
