// How wrong a registration may be, and whether it may be relied on. The residual says almost nothing about the error at
// the target; what counts is what the touched surface holds fast, how the errors along a stroke hang together, and
// whether another pose fits as well.
#pragma once

#include "navigation/registration/prepared_bone.h"
#include "navigation/registration/pose_pool.h"

namespace arthronaut::registration {

// The best pose of the pool with all that can be said about it. An empty pool gives a summary without a pose.
[[nodiscard]] RegistrationSummary summarise(const PreparedBone::Data& bone, const PosePool& pool,
                                            const TouchedPoints& points, const strokes::Curves& curves,
                                            const RegistrationOptions& options);

// What the touched points and the prior hold fast: the inverse of the covariance of a twist of the bone frame about
// `pivot_mm` (bone frame), correlated errors in. Nothing is held less than by the bone's own size.
[[nodiscard]] geometry::Matrix6d information_about(const RefinedPose& pose, const TouchedPoints& points,
                                                   const PreparedBone::Data& bone, const MarkerPrior& prior,
                                                   const Eigen::Vector3d& pivot_mm);

}  // namespace arthronaut::registration
