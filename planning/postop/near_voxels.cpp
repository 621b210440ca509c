#include "planning/postop/near_voxels.h"

#include <cmath>

namespace arthronaut::postop {

namespace {

// By which the axis' ends may move, and its reach grow with that.
constexpr double kMoves_mm = 1;

}  // namespace

const std::vector<WallVoxel>& NearVoxels::about(const BoreFrame& frame, double reach_mm) {
  // What is nearer than the reach to an axis with its ends so far off is nearer than both together to the old
  // one; and off its ends by no more than that move and what the tilt makes of the reach.
  if (about_) {
    const double moved_mm = frame.ends_off_mm(*about_);
    if (moved_mm <= kMoves_mm && reach_mm + moved_mm <= about_reach_mm_ + kMoves_mm) return near_;
  }
  about_ = frame;
  about_reach_mm_ = reach_mm;
  near_.clear();
  const double off_mm = reach_mm + kMoves_mm,
               along_mm = frame.half_mm() + kMoves_mm * (1 + off_mm / frame.half_mm());
  for (const WallVoxel& voxel : all_) {
    const Eigen::Vector3d w = voxel.p_mm - frame.middle();
    const double along = w.dot(frame.direction());
    if (std::abs(along) < along_mm && w.squaredNorm() - along * along < off_mm * off_mm)
      near_.push_back(voxel);
  }
  return near_;
}

}  // namespace arthronaut::postop
