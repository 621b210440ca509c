// The axis and the diameter of a bore from the voxels about its wall. Inner header of postop.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "planning/postop/tunnel_search.h"
#include "planning/postop/wall_profile.h"
#include "planning/postop/wall_voxels.h"

namespace arthronaut::postop {

// Which voxels tell of the wall: those free of metal, or those of a screw that fills the bore.
enum class Wall { Clear, Screw };

// How much blur a wall without a rim is seen through: as the mean profile looks, or is known; or as explains
// all of the wall best, one number more beside axis and radii, which the sigmas then count.
enum class Blur { AsItLooks, Fitted };

// A stretch of the bore, 4 mm long.
struct Stretch {
  double from_entry_mm = 0;  // of its middle, along the axis
  double diameter_mm = 0;
  // One sigma of it: by the noise of the grey alone, which tells whether it is seen at all, and with how far
  // eighths of the wall agree and what the wall's own shape leaves open.
  double noise_sigma_mm = std::numeric_limits<double>::infinity();
  double diameter_sigma_mm = std::numeric_limits<double>::infinity();
  // Of its wall within the bone: grey differs across it, the same way all around. What differs the other way
  // is taken off.
  double seen_share = 0;
  double metal_share = 0;  // of the voxels inside it
  // Of its seen wall outside the bore and its rim, HU, and inside it.
  double outside_hu = 0, inside_hu = 0;
};

struct TunnelFit {
  bool is_fitted = false;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  // on the axis, in the plan's frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double radius_mm = 0;  // median over what is seen
  // One sigma, by the noise of the grey or by how far eighths of the wall agree, whichever is more: of the
  // axis at the entry, across it, and of its direction.
  double entry_sigma_mm = std::numeric_limits<double>::infinity();
  double direction_sigma_rad = std::numeric_limits<double>::infinity();
  double freedom = 1;  // how many eighths more than numbers tell of these sigmas
  // Of the mean diameter; by whether there is a rim, too.
  double diameter_sigma_mm = std::numeric_limits<double>::infinity();
  WallProfile profile;
  std::vector<Stretch> stretches;  // from the entry on
};

// From a bore that is right to a millimetre or so. The voxels are explained as the blurred picture of two
// sides, parted where the wall is: inside one level for each step along the bore; outside the bone as it is
// at the same depth under its surface a little further from the wall, less by how much each cell of the wall
// is off that, which is fitted too; and where that explains them clearly better a rim between the two, the
// same all along. Axis and radii by robust least squares on the grey (Gauss-Newton), so that what differs
// much tells much, what does not differ tells nothing, and the bore may be brighter than the marrow or
// darker. Only stations `from_mm` to `to_mm` along the axis from the bore's entry count. `known`: rim and
// blur, not to be sought; `blur`: where there is no rim.
[[nodiscard]] TunnelFit fit_tunnel(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm,
                                   double to_mm, Wall wall, const std::optional<WallProfile>& known = {},
                                   Blur blur = Blur::AsItLooks);

}  // namespace arthronaut::postop
