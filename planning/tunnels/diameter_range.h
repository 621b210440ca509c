// How wide a tunnel can be planned, by key, by command and by default: from a thin drill to more than any
// graft asks for. What is customary within it the plan's checks say (plan_norms.h).
#pragma once

namespace arthronaut::tunnels {

inline constexpr double kLeastDiameter_mm = 3, kGreatestDiameter_mm = 15;

}  // namespace arthronaut::tunnels
