// What the strokes hold, first order about a refined pose: the pose, and how large they are beside the bone.
#pragma once

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/pose_pool.h"

namespace arthronaut::registration {

// Covariance of a twist of the bone frame about `pivot_mm` (bone frame). Robust ("sandwich"): the curvature
// of the cost on both sides, and between them how much the pull of whole stretches of path scatters, which
// holds correlated errors and whatever else the noise model leaves out. What nothing holds is off by
// no more than the bone's own size.
[[nodiscard]] geometry::Matrix6d covariance_about(const RefinedPose& pose, const WeightedPoints& points,
                                                  const SurfaceIndex::Data& bone, const MarkerPrior& prior,
                                                  const Eigen::Vector3d& pivot_mm);

struct SizeEstimate {
  StrokeScale scale;
  // Twist of the bone frame about the pivot by which the pose errs where the strokes are too large about
  // their world marker, for each whole of them: 1 % too large errs by a hundredth.
  geometry::Vector6d drift = geometry::Vector6d::Zero();
  // Covariance of the bone frame's twist about the pivot that comes of a scale that nobody corrects: as often
  // as markers, cameras and images are out, how far they may be, and what the strokes say of it. Far less
  // than the estimate's own sigma where the strokes hardly hold it.
  [[nodiscard]] geometry::Matrix6d covariance() const;
};

// One step of Gauss-Newton from the pose, with a thickness that the whole touched surface may lie off the
// mesh by as a nuisance: an even layer of cartilage is no error of scale. Covariance as above.
[[nodiscard]] SizeEstimate estimate_size(const RefinedPose& pose, const WeightedPoints& points,
                                         const SurfaceIndex::Data& bone, const MarkerPrior& prior,
                                         const Eigen::Vector3d& pivot_mm);

}  // namespace arthronaut::registration
