// How wrong a registration may be, and whether it may be relied on. The residual says almost nothing about the error at
// the target; what counts is what the touched surface holds fast, how the errors along a stroke hang together, and
// whether another pose fits as well.
#pragma once

#include "navigation/registration/prepared_bone.h"
#include "navigation/registration/refinement.h"

namespace arthronaut::registration {

// Covariance of the body twist of marker_from_bone, correlated errors in. Huge, but finite, where nothing holds a motion.
[[nodiscard]] geometry::Matrix6d covariance_of(const RefinedPose& pose, const TouchedPoints& points,
                                               const PreparedBone::Data& bone, const MarkerPrior& prior);

// Fills in rms, inliers, verdict and reasons from the best pose and the runner-up's ratio.
void judge(const RefinedPose& best, const TouchedPoints& points, double length_mm, RegistrationSummary& summary);

}  // namespace arthronaut::registration
