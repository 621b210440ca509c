// Two tunnels in one bone, as for two bundles: how much bone is between them.
#pragma once

#include <Eigen/Core>

#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

struct TunnelGap {
  // Between the two as solid cylinders of their lengths, flat at both ends; negative where they run into each
  // other: by so much less than the sum of the radii their axes stand apart.
  double bone_mm = 0;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // half way between, where it is least
};

// Both measured in the same bone and both entering it (TunnelGeometry::enters_bone). Right to 0.01 mm.
[[nodiscard]] TunnelGap gap_between(const Tunnel& first, const TunnelGeometry& first_measured,
                                    const Tunnel& second, const TunnelGeometry& second_measured);

}  // namespace arthronaut::tunnels
