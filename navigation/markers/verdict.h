// Whether a measured pose stands, and what to say when it does not.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "navigation/markers/direct_alignment.h"
#include "navigation/markers/edge_pose.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/planar_pose.h"

namespace arthronaut::markers {

inline constexpr double kMinEdgeShare = 0.3;  // of the edges crossed along x, and along y
inline constexpr double kMaxEdgeRmsPx = 1.2;  // how far an edge, or a corner, may lie from the pose

// Turned from each other by more than does no harm.
[[nodiscard]] bool are_unlike(const geometry::RigidTransform& a, const geometry::RigidTransform& b);

// Less apart than makes another measurement of it, as starts.
[[nodiscard]] bool are_alike(const geometry::RigidTransform& a, const geometry::RigidTransform& b);

// Whether a pose with this covariance of its body twist may stand: one sigma in all directions together.
[[nodiscard]] bool is_known_well_enough(const geometry::Matrix6d& covariance);

// How badly edges agree with their pose: their scatter over the share that is found.
[[nodiscard]] inline double misfit_of(const EdgePose& fit) {
  return std::max(1.0, fit.scale) / (fit.share[0] + fit.share[1]);
}

// What the edges say. The observation holds the corners that they make; `other` is the second pose that the
// corners allow; `is_found`: nothing is known from frames before.
[[nodiscard]] MarkerState judge(const EdgePose& fit, const MarkerObservation& observation,
                                const std::optional<SquarePose>& other, bool is_found);
// What the direct fit says. The observation holds its covariance; max_rms_px: how far the corners that single
// edges make may lie from the fit, of which one side has to be seen. nullopt: edges say nothing of it.
[[nodiscard]] MarkerState judge(const DirectPose& fit, std::optional<double> max_rms_px,
                                const MarkerObservation& observation);
// By what most of the edges that are missing at the supposed pose look like.
[[nodiscard]] MarkerState reason_of_loss(const geometry::RigidTransform& camera_from_marker,
                                         std::span<const EdgeMeasurement> measurements, double cell_px);

}  // namespace arthronaut::markers
