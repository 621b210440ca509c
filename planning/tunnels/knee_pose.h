// Whether femur and tibia of a case lie in one frame: only then are two tunnels one graft. Two meshes that
// were made apart, or bones of two scans between which somebody got up, have coordinates of their own each.
// Inner header of tunnels: see knee_checks.h.
#pragma once

#include <string>

#include "planning/tunnels/knee_checks.h"

namespace arthronaut::tunnels {

// Where the plateau's middle lies to the middle between the condyles' centres, of a knee of average size: no
// further along the hinge than kFurthestAlong_mm, from kNearestAcross_mm to kFurthestAcross_mm across it,
// turned about it by kMostExtended_deg to kMostFlexed_deg from straight below. On bones of one scan each,
// real and made: 1 to 10 mm along, 25 to 39 mm across. Flexing turns about the hinge and changes neither.
inline constexpr double kFurthestAlong_mm = 20, kNearestAcross_mm = 12, kFurthestAcross_mm = 50;
inline constexpr double kMostExtended_deg = -60, kMostFlexed_deg = 140;
// Between the lateral directions of the two bones. One that was read in the other axes (LPS, RAS) stands at
// 180 degrees; a tibia turns by 20 to 30 at most.
inline constexpr double kMostTurned_deg = 60;

// Why they do not, in words that follow "femur and tibia do not lie in one frame: "; empty where nothing says
// so, as where a bone is not known. Condyles: the flexion axis, else Blumensaat's line. Plateau: its
// landmarks, else the tibia's end, along its shaft or, where that does not tell, as it stands in the scanner:
// that serves up to some 60 degrees of flexion.
[[nodiscard]] std::string why_apart(const KneeSurroundings& knee);

}  // namespace arthronaut::tunnels
