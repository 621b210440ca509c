#include "navigation/registration/verdict/held_by_strokes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "navigation/registration/search/pose_step.h"

namespace arthronaut::registration {

using geometry::Matrix6d;
using geometry::Vector6d;

namespace {

constexpr double kMeasuredShare = 0.7;
constexpr double kBoneSize_mm = 30, kBoneTurn_rad = 3;
constexpr double kLayer_mm = 1;  // that the whole surface may lie off the mesh by, one sigma

// A pose, and with 8 parameters the growth of the strokes about the pivot and a layer on the bone.
template <int kParameters>
struct Held {
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;
  using Vector = Eigen::Matrix<double, kParameters, 1>;

  Matrix held = Matrix::Zero(), pull = Matrix::Zero();
  Vector slope = Vector::Zero();

  void add_knowledge(const Vector& row, double sigma) {
    const Matrix known = row * row.transpose() * (kCorrelationLength_mm / (sigma * sigma));
    held += known;
    pull += kCorrelationLength_mm * known;
  }
  [[nodiscard]] Matrix inverse() const { return held.ldlt().solve(Matrix::Identity()); }
};

// step: by which the parameters are further on than the pose.
template <int kParameters>
Held<kParameters> held_by(const RefinedPose& pose, const WeightedPoints& points,
                          const SurfaceIndex::Data& bone, const MarkerPrior& prior,
                          const Eigen::Vector3d& pivot_mm, const typename Held<kParameters>::Vector& step) {
  using Vector = typename Held<kParameters>::Vector;
  Held<kParameters> sum;
  double curvature = 0, information = 1e-9;
  Vector stretch_pull = Vector::Zero();
  int stretch_count = 0;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    const Eigen::Vector3d arm_mm = pose.bone_from_marker * points.positions_mm[i] - pivot_mm;
    const Eigen::Vector3d gradient = bone.field.sample(pivot_mm + arm_mm).gradient;
    Vector row;
    row.template head<6>() = row_of(gradient, arm_mm);
    // Errors are the tip's, so strokes that shrink are to shrink away no residual: it is taken in their size.
    if constexpr (kParameters == 8) row.template tail<2>() << gradient.dot(arm_mm) - pose.residuals_mm[i], -1;
    const ResidualEvidence evidence = evidence_of(pose.residuals_mm[i] + row.dot(step), pose.model);
    sum.held += points.weights[i] * evidence.information * row * row.transpose();
    curvature += points.weights[i] * evidence.curvature;
    information += points.weights[i] * evidence.information;
    stretch_pull += points.weights[i] * evidence.slope * row;
    if (i + 1 == points.positions_mm.size() || points.stretches[i + 1] != points.stretches[i]) {
      sum.pull += stretch_pull * stretch_pull.transpose();
      sum.slope += stretch_pull;
      stretch_pull.setZero();
      ++stretch_count;
    }
  }
  // So many parameters were fitted to the stretches.
  sum.pull *= stretch_count / std::max<double>(stretch_count - kParameters, 1);
  // Few stretches measure the scatter poorly: a part of it is what the noise model expects.
  sum.pull = kMeasuredShare * sum.pull + (1 - kMeasuredShare) * kCorrelationLength_mm * sum.held;
  // Where it is not known which explanation holds, a residual says less than if it were.
  sum.held *= std::clamp(curvature / information, 0.2, 1.0);

  if (prior.use) {
    const Eigen::Vector3d& marker = pose.bone_from_marker.translation_mm;
    Vector row = Vector::Zero();
    row.template head<6>() = row_of(bone.field.sample(marker).gradient, marker - pivot_mm);
    sum.add_knowledge(row, prior.sigma_mm);
  }
  for (int k = 0; k < 6; ++k) sum.add_knowledge(Vector::Unit(k), k < 3 ? kBoneSize_mm : kBoneTurn_rad);
  return sum;
}

}  // namespace

Matrix6d covariance_about(const RefinedPose& pose, const WeightedPoints& points,
                          const SurfaceIndex::Data& bone, const MarkerPrior& prior,
                          const Eigen::Vector3d& pivot_mm) {
  const Held<6> sum = held_by<6>(pose, points, bone, prior, pivot_mm, Vector6d::Zero());
  const Matrix6d inverse = sum.inverse();
  return inverse * sum.pull * inverse;
}

SizeEstimate estimate_size(const RefinedPose& pose, const WeightedPoints& points,
                           const SurfaceIndex::Data& bone, const MarkerPrior& prior,
                           const Eigen::Vector3d& pivot_mm) {
  constexpr int kGrowth = 6, kLayer = 7;
  const auto sum_at = [&](const Held<8>::Vector& step) {
    Held<8> sum = held_by<8>(pose, points, bone, prior, pivot_mm, step);
    sum.add_knowledge(Held<8>::Vector::Unit(kLayer), kLayer_mm);
    sum.slope.head<6>().setZero();  // the pose is the best one, the marker and all
    return sum;
  };
  const Held<8> sum = sum_at(Held<8>::Vector::Zero());
  const Held<8>::Vector step = -sum.inverse() * sum.slope;
  // How the stretches scatter shows where their common error of scale is taken out.
  const Held<8> there = sum_at(step);
  const Held<8>::Matrix inverse = there.inverse();
  SizeEstimate size;
  size.scale.ratio = 1 - step[kGrowth];
  size.scale.sigma = std::sqrt((inverse * there.pull * inverse)(kGrowth, kGrowth));
  const Matrix6d held = sum.held.topLeftCorner<6, 6>();
  const Vector6d by_growth = sum.held.col(kGrowth).head<6>();
  size.drift = -held.ldlt().solve(by_growth);
  size.drift.head<3>() -= pivot_mm - pose.bone_from_marker.translation_mm;
  return size;
}

Matrix6d SizeEstimate::covariance() const {
  // Markers, cameras and images as they should be, and one in twenty that is not.
  struct Kind {
    double share, sigma;
  };
  constexpr Kind kKinds[]{{0.95, 0.002}, {0.05, 0.04}};
  double weight_sum = 0, square_sum = 0;
  for (const auto& [share, sigma] : kKinds) {
    const double variance = sigma * sigma + scale.sigma * scale.sigma, off = scale.ratio - 1;
    const double weight = share * std::exp(-0.5 * off * off / variance) / std::sqrt(variance);
    const double kept = sigma * sigma / variance;  // of what was measured
    weight_sum += weight;
    square_sum += weight * (kept * kept * off * off + kept * scale.sigma * scale.sigma);
  }
  return square_sum / weight_sum * drift * drift.transpose();
}

}  // namespace arthronaut::registration
