// From a rough pose to the best one nearby.
//
// What the tip tells is not symmetric: it never goes into the bone, but it is lifted off, and it rides on
// soft tissue. So the noise model of a residual (signed distance to the bone) is a mixture of three: contact,
// normal about 0; soft tissue, normal about 0.9 mm; lifted, any height above the bone, and hardly ever inside
// it. Their shares and the contact's spread are found with the pose by expectation maximisation (A. P.
// Dempster, N. M. Laird, D. B. Rubin, "Maximum likelihood from incomplete data via the EM algorithm", Journal
// of the Royal Statistical Society B 39, 1977). Registration by EM over a mixture with a part for what lies
// nowhere near is known from A. Myronenko, X. Song, "Point set registration: coherent point drift", IEEE
// TPAMI 32, 2010; there the parts are points, here they are ways in which a tip meets a surface.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "navigation/registration/bone/distance_field.h"
#include "navigation/registration/search/weighted_points.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::registration {

// Signed distance and its gradient at a point of the bone frame, such as the exact mesh's.
using DistanceFunction = std::function<DistanceField::Sample(const Eigen::Vector3d&)>;

struct NoiseModel {
  double contact_sigma_mm = 0.4;
  double soft_share = 0.10;
  double lifted_share = 0.10;
  // Of a lifted point inside the bone, by mm: a gross error, twenty times rarer than a lift. As likely as a
  // lift where the mesh may hold cartilage that is not there.
  double buried_density_per_mm = kRarelyBuried_per_mm;
  static constexpr double kRarelyBuried_per_mm = 0.01, kOftenBuried_per_mm = 0.2;
};

// Errors along a stroke are autocorrelated: about this much of path makes one independent measurement. Costs
// and weights count touched mm; what is known otherwise (the marker's prior) counts for so many of them.
inline constexpr double kCorrelationLength_mm = 5.0;

// The world marker is the plate of a screw head: its centre a little above the bone, its face outwards.
struct MarkerPrior {
  bool use = false;
  double height_mm = 2.0, sigma_mm = 0.7;              // of the marker's centre above the bone
  double free_tilt_rad = 0.44, tilt_sigma_rad = 0.10;  // no objection up to 25 degrees
};

struct RefinedPose {
  geometry::RigidTransform bone_from_marker;
  NoiseModel model;
  double cost = 0;  // weighted negative log likelihood for each unit of weight; smaller is better
  std::vector<double> residuals_mm;  // signed, by point
  std::uint32_t searches = 0;        // that led here, one bit each; see PosePool::best_find_count
};

// What the noise model says about one residual: the derivatives of its negative log density.
struct ResidualEvidence {
  double contact = 0;      // probability that the tip touched the bone
  double slope = 0;        // first derivative, 1/mm
  double curvature = 0;    // second derivative, 1/mm^2; negative where explanations compete
  double information = 0;  // the curvature if it were known which explanation holds, 1/mm^2
};
[[nodiscard]] ResidualEvidence evidence_of(double residual_mm, const NoiseModel& model);

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

// EM from a pose within about 1 mm; by the grid, or by any other distance, which takes longer.
[[nodiscard]] RefinedPose refine(const DistanceField& field, const WeightedPoints& points,
                                 const geometry::RigidTransform& bone_from_marker, const NoiseModel& model,
                                 const MarkerPrior& prior, int iterations);
[[nodiscard]] RefinedPose refine(const DistanceFunction& distance, const WeightedPoints& points,
                                 const geometry::RigidTransform& bone_from_marker, const NoiseModel& model,
                                 const MarkerPrior& prior, int iterations);

}  // namespace arthronaut::registration
