// Where in a bone something like a drilled tunnel is seen: a round, straight bore that is darker than the
// bone all around it. Inner header of postop.
#pragma once

#include <vector>

#include "planning/postop/bone_grid.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::postop {

// How far from the plan is looked.
inline constexpr double kSearched_mm = 18, kSearched_deg = 35;
// Of a graft. What is denser than this and than the bone around it is a plug of bone.
inline constexpr double kMostSoft_hu = 120;

struct Bore {
  Eigen::Vector3d entry_mm;   // where its axis enters the bone, to a cell
  Eigen::Vector3d direction;  // unit, into the bone
  double radius_mm = 0;
  double evidence = 0;  // sum of the contrasts that are seen all around, HU
};

// The strongest bores, best first, each another than those before it. Every axis within the limits above is
// tried, on steps of 1.5 mm and 6 degrees, and then in finer ones where something is seen.
[[nodiscard]] std::vector<Bore> search_bores(const BoneGrid& grid, const tunnels::Tunnel& plan);

}  // namespace arthronaut::postop
