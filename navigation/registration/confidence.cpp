#include "navigation/registration/confidence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

using geometry::cross_matrix;
using geometry::Matrix6d;
using geometry::Vector6d;

namespace {

constexpr double kMeasuredShare = 0.7;
constexpr double kBoneSize_mm = 30, kBoneTurn_rad = 3;

Vector6d row_of(const Eigen::Vector3d& gradient, const Eigen::Vector3d& arm_mm) {
  Vector6d row;
  row << gradient, arm_mm.cross(gradient);
  return row;
}

// The covariance of marker_from_bone's body twist from that of the bone frame's twist about the pivot.
Matrix6d about_origin(const Matrix6d& about_pivot, const Eigen::Vector3d& pivot_mm) {
  Matrix6d shift = Matrix6d::Identity();
  shift.topRightCorner<3, 3>() = cross_matrix(pivot_mm);
  const Matrix6d covariance = shift * about_pivot * shift.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

void measure_inliers(const RefinedPose& best, const TouchedPoints& points, RegistrationSummary& summary) {
  constexpr double kInlier_mm = 1.0;
  double inlier_weight = 0, square_sum = 0;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    if (std::abs(best.residuals_mm[i]) > kInlier_mm) continue;
    inlier_weight += points.weights[i];
    square_sum += points.weights[i] * best.residuals_mm[i] * best.residuals_mm[i];
  }
  summary.rms_mm = inlier_weight > 0 ? std::sqrt(square_sum / inlier_weight) : 0.0;
  summary.inlier_fraction = inlier_weight / std::max(points.weight_sum, 1e-9);
}

std::vector<std::string> doubts(const RegistrationSummary& summary, double length_mm) {
  std::vector<std::string> reasons;
  if (length_mm < 40) reasons.push_back("too little was touched: draw at least 100 mm of strokes");
  if (summary.inlier_fraction < 0.55) reasons.push_back("too few of the points lie on this bone");
  if (summary.predicted_tre_mm > 2.0) {
    reasons.push_back("the touched patch does not hold the bone fast: touch other faces of the notch too");
  }
  if (summary.runner_up_ratio < 1.15) reasons.push_back("two poses fit almost alike");
  return reasons;
}

}  // namespace

Matrix6d covariance_about(const RefinedPose& pose, const TouchedPoints& points, const PreparedBone::Data& bone,
                          const MarkerPrior& prior, const Eigen::Vector3d& pivot_mm) {
  Matrix6d held = Matrix6d::Zero(), pull = Matrix6d::Zero();
  double curvature = 0, information = 1e-9;
  Vector6d stretch_pull = Vector6d::Zero();
  int stretch_count = 0;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    const Eigen::Vector3d p = pose.bone_from_marker * points.positions_mm[i];
    const Vector6d row = row_of(bone.field.sample(p).gradient, p - pivot_mm);
    const ResidualEvidence evidence = evidence_of(pose.residuals_mm[i], pose.model);
    held += points.weights[i] * evidence.information * row * row.transpose();
    curvature += points.weights[i] * evidence.curvature;
    information += points.weights[i] * evidence.information;
    stretch_pull += points.weights[i] * evidence.slope * row;
    if (i + 1 == points.positions_mm.size() || points.stretches[i + 1] != points.stretches[i]) {
      pull += stretch_pull * stretch_pull.transpose();
      stretch_pull.setZero();
      ++stretch_count;
    }
  }
  // Six parameters were fitted to the stretches.
  pull *= stretch_count / std::max(stretch_count - 6.0, 1.0);
  // Few stretches measure the scatter poorly: a part of it is what the law of the residuals expects.
  pull = kMeasuredShare * pull + (1 - kMeasuredShare) * kCorrelationLength_mm * held;
  // Where it is not known which explanation holds, a residual says less than if it were.
  held *= std::clamp(curvature / information, 0.2, 1.0);

  const auto add_knowledge = [&](const Vector6d& row, double sigma) {
    const Matrix6d known = row * row.transpose() * (kCorrelationLength_mm / (sigma * sigma));
    held += known;
    pull += kCorrelationLength_mm * known;
  };
  if (prior.use) {
    const Eigen::Vector3d& marker = pose.bone_from_marker.translation_mm;
    add_knowledge(row_of(bone.field.sample(marker).gradient, marker - pivot_mm), prior.sigma_mm);
  }
  for (int k = 0; k < 6; ++k) add_knowledge(Vector6d::Unit(k), k < 3 ? kBoneSize_mm : kBoneTurn_rad);
  const Matrix6d inverse = held.ldlt().solve(Matrix6d::Identity());
  return inverse * pull * inverse;
}

RegistrationSummary summarise(const PreparedBone::Data& bone, const PosePool& pool, const TouchedPoints& points,
                              const strokes::Curves& curves, const RegistrationOptions& options) {
  RegistrationSummary summary;
  summary.point_count = static_cast<int>(curves.size());
  if (pool.empty()) {
    summary.reasons = {"no pose was found that puts the touched curves on this bone"};
    return summary;
  }
  const RefinedPose& best = pool.best();
  const Eigen::Vector3d pivot = best.bone_from_marker * points.centroid_mm;
  summary.has_pose = true;
  summary.marker_from_bone = best.bone_from_marker.inverse();
  summary.covariance = about_origin(covariance_about(best, points, bone, pool.prior(), pivot), pivot);
  summary.predicted_tre_mm = predicted_error_mm(summary, options.target_in_bone_mm.value_or(pivot));
  constexpr double kNoRival = 10;
  summary.runner_up_ratio = pool.runner_up() ? std::exp(pool.runner_up()->cost - best.cost) : kNoRival;
  measure_inliers(best, points, summary);
  for (const strokes::CurvePoint& point : curves) {
    const Eigen::Vector3d p = best.bone_from_marker * point.position_mm;
    const double distance_mm = bone.field.sample(p).distance_mm;
    summary.point_residuals_mm.push_back(std::abs(distance_mm) < bone.field.band_mm() ? distance_mm
                                                                                      : bone.surface.signed_distance_mm(p));
  }
  summary.reasons = doubts(summary, strokes::stroke_length_mm(curves));
  summary.reliable = summary.reasons.empty();
  return summary;
}

}  // namespace arthronaut::registration
