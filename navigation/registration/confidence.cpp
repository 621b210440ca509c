#include "navigation/registration/confidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace arthronaut::registration {

using geometry::cross_matrix;
using geometry::Matrix6d;
using geometry::Vector6d;

namespace {

// Errors hang together over about this much of path.
constexpr double kCorrelationLength_mm = 6.0;

}  // namespace

Matrix6d covariance_of(const RefinedPose& pose, const TouchedPoints& points, const PreparedBone::Data& bone,
                       const MarkerPrior& prior) {
  const Eigen::Vector3d pivot = pose.bone_from_marker * points.centroid_mm;
  const double information = 1.0 / (pose.model.contact_sigma_mm * pose.model.contact_sigma_mm * kCorrelationLength_mm);
  Matrix6d held = Matrix6d::Zero();
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    const Eigen::Vector3d p = pose.bone_from_marker * points.positions_mm[i];
    const Eigen::Vector3d gradient = bone.field.sample(p).gradient;
    Vector6d row;
    row << gradient, (p - pivot).cross(gradient);
    held += points.weights[i] * pose.contact_weights[i] * information * row * row.transpose();
  }
  if (prior.use) {
    const Eigen::Vector3d& marker = pose.bone_from_marker.translation_mm;
    const Eigen::Vector3d gradient = bone.field.sample(marker).gradient;
    Vector6d row;
    row << gradient, (marker - pivot).cross(gradient);
    held += row * row.transpose() / (prior.sigma_mm * prior.sigma_mm);
  }
  // The bone is 10 cm large: what nothing holds is off by no more than 30 mm and half a turn.
  held.topLeftCorner<3, 3>().diagonal().array() += 1.0 / (30.0 * 30.0);
  held.bottomRightCorner<3, 3>().diagonal().array() += 1.0 / (3.0 * 3.0);
  const Matrix6d about_pivot = held.ldlt().solve(Matrix6d::Identity());
  Matrix6d shift = Matrix6d::Identity();
  shift.topRightCorner<3, 3>() = cross_matrix(pivot);
  const Matrix6d covariance = shift * about_pivot * shift.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

void judge(const RefinedPose& best, const TouchedPoints& points, double length_mm, RegistrationSummary& summary) {
  constexpr double kInlier_mm = 1.0;
  double inlier_weight = 0, square_sum = 0;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    if (std::abs(best.residuals_mm[i]) > kInlier_mm) continue;
    inlier_weight += points.weights[i];
    square_sum += points.weights[i] * best.residuals_mm[i] * best.residuals_mm[i];
  }
  summary.rms_mm = inlier_weight > 0 ? std::sqrt(square_sum / inlier_weight) : 0.0;
  summary.inlier_fraction = inlier_weight / std::max(points.weight_sum, 1e-9);
  summary.reasons.clear();
  if (length_mm < 40) summary.reasons.push_back("too little was touched: draw at least 100 mm of strokes");
  if (summary.inlier_fraction < 0.55) summary.reasons.push_back("too few of the points lie on this bone");
  if (summary.predicted_tre_mm > 2.0) {
    summary.reasons.push_back("the touched patch does not hold the bone fast: touch other faces of the notch too");
  }
  if (summary.runner_up_ratio < 1.1) summary.reasons.push_back("two poses fit almost alike");
  summary.reliable = summary.reasons.empty();
}

}  // namespace arthronaut::registration
