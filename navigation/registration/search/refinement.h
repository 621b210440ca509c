// From a rough pose to the best one nearby.
//
// What a residual says goes by noise_model.h; its parameters are found with the pose.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/registration/bone/distance_field.h"
#include "navigation/registration/search/noise_model.h"
#include "navigation/registration/search/weighted_points.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::registration {

// Errors along a stroke are autocorrelated: about this much of path makes one independent measurement. Costs
// and weights count touched mm; what is known otherwise (the marker's prior) counts for so many of them.
inline constexpr double kCorrelationLength_mm = 5.0;

// The world marker is the plate of a screw head: its centre a little above the bone, its face outwards.
struct MarkerPrior {
  bool use = false;
  double height_mm = 2.0, sigma_mm = 0.7;              // of the marker's centre above the bone
  double free_tilt_rad = 0.44, tilt_sigma_rad = 0.10;  // no objection up to 25 degrees
};

// Robust: a marker that stands otherwise than usual must not bend the result, and costs no more than some
// 20 mm of path that miss the bone.
struct MarkerObjection {
  double cost;         // negative log likelihood
  double information;  // about its height above the bone, 1/mm^2
};
// sample: of the bone, at the marker.
[[nodiscard]] MarkerObjection object_to(const Eigen::Matrix3d& bone_from_marker,
                                        const DistanceField::Sample& sample, const MarkerPrior& prior);

struct RefinedPose {
  geometry::RigidTransform bone_from_marker;
  NoiseModel model;
  double cost = 0;  // weighted negative log likelihood for each unit of weight; smaller is better
  std::vector<double> residuals_mm;  // signed, by point
  std::uint32_t searches = 0;        // that led here, one bit each; see PosePool::best_find_count
};

// Geman-McClure, its width shrinking from first_width_mm to last_width_mm over two thirds of the iterations:
// from several mm and degrees away to the minimum.
struct ApproachOptions {
  double first_width_mm = 2.0, last_width_mm = 0.8;
  int max_iterations = 18;
};
struct ApproachedPose {
  geometry::RigidTransform bone_from_marker;
  double cost = 1;  // mean of r^2 / (width^2 + r^2) before the last step; in [0, 1], smaller is better
};
[[nodiscard]] ApproachedPose approach(const DistanceField& field, const WeightedPoints& points,
                                      const geometry::RigidTransform& bone_from_marker,
                                      const ApproachOptions& options = {});

// EM from a pose within about 1 mm. Each point speaks for itself: see along_strokes.h for what comes last.
[[nodiscard]] RefinedPose refine(const DistanceField& field, const WeightedPoints& points,
                                 const geometry::RigidTransform& bone_from_marker, const NoiseModel& model,
                                 const MarkerPrior& prior, int iterations);

}  // namespace arthronaut::registration
