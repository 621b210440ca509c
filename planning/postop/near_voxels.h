// The voxels near a bore that moves little by little, as a fit does: sought among all of them only once it
// has moved farther than the room that was left. Inner header of postop.
#pragma once

#include <vector>

#include "planning/postop/bore_frame.h"
#include "planning/postop/wall_voxels.h"

namespace arthronaut::postop {

class NearVoxels {
 public:
  // `all` must outlive it.
  explicit NearVoxels(const std::vector<WallVoxel>& all) : all_(all) {}

  // All of those between the stations and within `reach_mm` of the axis, in their order, and some beside
  // them. Valid until the next call.
  [[nodiscard]] const std::vector<WallVoxel>& about(const BoreFrame& frame, double reach_mm);

 private:
  const std::vector<WallVoxel>& all_;
  std::vector<WallVoxel> near_;
  std::optional<BoreFrame> about_;  // what `near_` was sought for
  double about_reach_mm_ = 0;
};

}  // namespace arthronaut::postop
