// 3D Slicer and OpenIGTLink keep everything in RAS; this program in LPS. So each frame is taken with x and y
// turned about, the world's and the tools' too: with F = diag(-1, -1, 1), what goes out is
// F * target_from_source * F.
#pragma once

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::openigtlink {

// F * t * F; its own inverse.
[[nodiscard]] geometry::RigidTransform ras_from_lps(const geometry::RigidTransform& target_from_source);

}  // namespace arthronaut::openigtlink
