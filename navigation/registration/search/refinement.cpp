#include "navigation/registration/search/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace arthronaut::registration {

namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;

// Twists (v, w) about a point near the touched area, in the bone frame: bone_from_marker <- twist *
// bone_from_marker.
struct NormalEquations {
  Matrix6d matrix = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();

  void add(const Eigen::Vector3d& arm_mm, const Eigen::Vector3d& gradient, double residual_mm,
           double weight) {
    Vector6d row;
    row.head<3>() = gradient;
    row.tail<3>() = arm_mm.cross(gradient);
    // By pairs of rows, since these few products are most of the time of a fit; what lies above the diagonal
    // is not looked at.
    const Vector6d weighted = weight * row;
    matrix.col(0) += weighted[0] * row;
    matrix.col(1) += weighted[1] * row;
    matrix.col(2).tail<4>() += weighted[2] * row.tail<4>();
    matrix.col(3).tail<4>() += weighted[3] * row.tail<4>();
    matrix.col(4).tail<2>() += weighted[4] * row.tail<2>();
    matrix.col(5).tail<2>() += weighted[5] * row.tail<2>();
    right -= weighted * residual_mm;
  }

  // Slightly damped, so that a motion which nothing holds stays where it is; steps are kept within reason.
  [[nodiscard]] Vector6d solve() const {
    constexpr double kMaxTranslation_mm = 3.0, kMaxAngle_rad = 0.2;
    Matrix6d damped = matrix.selfadjointView<Eigen::Lower>();
    damped.diagonal().array() *= 1.0 + 1e-6;
    damped.diagonal().array() += 1e-6;
    Vector6d twist = damped.ldlt().solve(right);
    const double excess =
        std::max(twist.head<3>().norm() / kMaxTranslation_mm, twist.tail<3>().norm() / kMaxAngle_rad);
    if (excess > 1) twist /= excess;
    return twist.allFinite() ? twist : Vector6d::Zero();
  }
};

void move(RigidTransform& bone_from_marker, const Vector6d& twist, const Eigen::Vector3d& pivot_mm) {
  const Eigen::Vector3d w = twist.tail<3>();
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0) turn = Eigen::AngleAxisd(angle, w / angle);
  bone_from_marker.rotation = (turn * bone_from_marker.rotation).normalized();
  bone_from_marker.translation_mm =
      turn * (bone_from_marker.translation_mm - pivot_mm) + pivot_mm + twist.head<3>();
}

bool is_small(const Vector6d& twist) {
  return twist.head<3>().norm() < 1e-4 && twist.tail<3>().norm() < 1e-5;
}

// Laws of the three explanations. Lifts are alike up to the field's band, and all beyond it count as the last
// of them. Into the bone goes nothing but a gross error: a pose that buries strokes can't explain them away.
constexpr double kSoftHeight_mm = 0.9, kSoftSigma_mm = 0.37;
constexpr double kLiftedDensity_per_mm = 0.2, kLiftOnset_mm = 0.15;
constexpr double kMinSigma_mm = 0.06, kMaxSigma_mm = 0.6;

class NormalDensity {
 public:
  explicit NormalDensity(double sigma) : variance_(sigma * sigma), area_(sigma * 2.5066282746310002) {}
  [[nodiscard]] double at(double x) const { return std::exp(-0.5 * x * x / variance_) / area_; }

 private:
  double variance_, area_;
};

double lifted_density_per_mm(double residual_mm, double buried_density_per_mm) {
  const double share_above = 1 / (1 + std::exp(-residual_mm / kLiftOnset_mm));
  return buried_density_per_mm + (kLiftedDensity_per_mm - buried_density_per_mm) * share_above;
}

struct Explanation {
  double contact, soft, lifted;  // sum to 1
  double negative_log_density;
};

// By one noise model, of which all that many residuals share is worked out once.
class Explainer {
 public:
  explicit Explainer(const NoiseModel& model)
      : model_(model),
        contact_share_(1 - model.soft_share - model.lifted_share),
        contact_(model.contact_sigma_mm),
        soft_(std::hypot(kSoftSigma_mm, model.contact_sigma_mm)) {}

  [[nodiscard]] Explanation explain(double residual_mm) const {
    const double contact = contact_share_ * contact_.at(residual_mm);
    const double soft = model_.soft_share * soft_.at(residual_mm - kSoftHeight_mm);
    const double lifted =
        model_.lifted_share * lifted_density_per_mm(residual_mm, model_.buried_density_per_mm);
    const double sum = contact + soft + lifted;
    return {contact / sum, soft / sum, lifted / sum, -std::log(sum)};
  }

 private:
  NoiseModel model_;
  double contact_share_;
  NormalDensity contact_, soft_;
};

// The M step for the noise model, from how each residual is explained by the one before. The shares lean on a
// prior of a few mm of path, so that none dies out.
class ModelUpdate {
 public:
  void add(const Explanation& explanation, double residual_mm, double weight) {
    contact_ += weight * explanation.contact;
    soft_ += weight * explanation.soft;
    lifted_ += weight * explanation.lifted;
    square_sum_ += weight * explanation.contact * residual_mm * residual_mm;
  }
  [[nodiscard]] NoiseModel updated(const NoiseModel& model) const {
    NoiseModel updated = model;
    updated.contact_sigma_mm = std::clamp(std::sqrt(square_sum_ / contact_), kMinSigma_mm, kMaxSigma_mm);
    updated.soft_share = soft_ / (contact_ + soft_ + lifted_);
    updated.lifted_share = lifted_ / (contact_ + soft_ + lifted_);
    return updated;
  }

 private:
  static constexpr double kPriorWeight = 4.0;
  double contact_ = kPriorWeight, soft_ = 0.1 * kPriorWeight, lifted_ = 0.1 * kPriorWeight;
  double square_sum_ = 0.2 * 0.2 * kPriorWeight;
};

struct MarkerObjection {
  double cost, weight;  // weight: of the height's miss in the normal equations
};

// Robust: a marker that stands otherwise than usual must not bend the result, and costs no more than some 20
// mm of path.
MarkerObjection object_to(const Eigen::Matrix3d& bone_from_marker, const DistanceField::Sample& sample,
                          const MarkerPrior& prior) {
  constexpr double kWidth = 9.0;  // squared, in sigmas
  const double miss = (sample.distance_mm - prior.height_mm) / prior.sigma_mm;
  const double tilt_rad = geometry::angle_between_rad(bone_from_marker.col(2), sample.gradient);
  const double excess = std::max(0.0, tilt_rad - prior.free_tilt_rad) / prior.tilt_sigma_rad;
  const double ratio = kWidth / (kWidth + miss * miss);
  const auto robust = [](double square) { return 0.5 * kWidth * square / (kWidth + square); };
  return {kCorrelationLength_mm * (robust(miss * miss) + robust(excess * excess)),
          kCorrelationLength_mm * ratio * ratio / (prior.sigma_mm * prior.sigma_mm)};
}

// How many points before its turn one is expected by the field: about what a look-up in main memory lasts.
constexpr std::size_t kAhead = 6;

// See refine() in the header. Distance: gives the sample at a point of the bone frame; expect: is told of the
// points to come.
template <typename Distance, typename Expect>
RefinedPose refine_by(const Distance& distance, const Expect& expect, const WeightedPoints& points,
                      const RigidTransform& start, const NoiseModel& model, const MarkerPrior& prior,
                      int iterations) {
  RefinedPose refined;
  refined.bone_from_marker = start;
  refined.model = model;
  refined.residuals_mm.resize(points.positions_mm.size());
  for (int iteration = 0;; ++iteration) {
    const bool is_last = iteration >= iterations;  // where the pose stays: its cost and residuals alone
    const Eigen::Vector3d pivot = refined.bone_from_marker * points.centroid_mm;
    const Eigen::Matrix3d rotation = refined.bone_from_marker.matrix();
    const double contact_information = 1 / (refined.model.contact_sigma_mm * refined.model.contact_sigma_mm);
    const double soft_information = 1 / (kSoftSigma_mm * kSoftSigma_mm + 1 / contact_information);
    const Explainer explainer(refined.model);
    NormalEquations equations;
    ModelUpdate model_update;
    double cost = 0;
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      const auto there = [&](std::size_t k) -> Eigen::Vector3d {
        return rotation * points.positions_mm[k] + refined.bone_from_marker.translation_mm;
      };
      if (i + kAhead < points.positions_mm.size()) expect(there(i + kAhead));
      const Eigen::Vector3d p = there(i);
      const DistanceField::Sample sample = distance(p);
      const double residual_mm = sample.distance_mm - points.offset_mm(i);
      refined.residuals_mm[i] = residual_mm;
      const Explanation explanation = explainer.explain(residual_mm);
      cost += points.weights[i] * explanation.negative_log_density;
      if (is_last) continue;
      model_update.add(explanation, residual_mm, points.weights[i]);
      const double contact = explanation.contact * contact_information,
                   soft = explanation.soft * soft_information;
      const double weight = contact + soft;
      if (weight < 1e-9) continue;
      equations.add(p - pivot, sample.gradient, residual_mm - kSoftHeight_mm * soft / weight,
                    points.weights[i] * weight);
    }
    if (prior.use) {
      const Eigen::Vector3d& marker = refined.bone_from_marker.translation_mm;
      const DistanceField::Sample sample = distance(marker);
      const MarkerObjection objection = object_to(rotation, sample, prior);
      equations.add(marker - pivot, sample.gradient, sample.distance_mm - prior.height_mm, objection.weight);
      cost += objection.cost;
    }
    refined.cost = cost / std::max(points.weight_sum, 1e-9);
    if (is_last) break;
    const Vector6d twist = equations.solve();
    move(refined.bone_from_marker, twist, pivot);
    refined.model = model_update.updated(refined.model);
    if (is_small(twist) && iteration > 3) iterations = iteration + 1;
  }
  return refined;
}

}  // namespace

ResidualEvidence evidence_of(double residual_mm, const NoiseModel& model) {
  const Explanation explanation = Explainer(model).explain(residual_mm);
  const double contact_information = 1 / (model.contact_sigma_mm * model.contact_sigma_mm);
  const double soft_information = 1 / (kSoftSigma_mm * kSoftSigma_mm + 1 / contact_information);
  const double contact_slope = residual_mm * contact_information;
  const double soft_slope = (residual_mm - kSoftHeight_mm) * soft_information;
  ResidualEvidence evidence;
  evidence.contact = explanation.contact;
  evidence.slope = explanation.contact * contact_slope + explanation.soft * soft_slope;
  evidence.information = explanation.contact * contact_information + explanation.soft * soft_information;
  const double square_slope =
      explanation.contact * contact_slope * contact_slope + explanation.soft * soft_slope * soft_slope;
  evidence.curvature = evidence.information - (square_slope - evidence.slope * evidence.slope);
  return evidence;
}

ApproachedPose approach(const DistanceField& field, const WeightedPoints& points, const RigidTransform& start,
                        const ApproachOptions& options) {
  ApproachedPose approached{start};
  RigidTransform& bone_from_marker = approached.bone_from_marker;
  const double shrinking_iterations = options.max_iterations * 2 / 3;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const double progress = std::min(1.0, iteration / shrinking_iterations);
    const double width =
        options.first_width_mm * std::pow(options.last_width_mm / options.first_width_mm, progress);
    const Eigen::Vector3d pivot = bone_from_marker * points.centroid_mm;
    const Eigen::Matrix3d rotation = bone_from_marker.matrix();
    NormalEquations equations;
    double cost = 0;
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      const auto there = [&](std::size_t k) -> Eigen::Vector3d {
        return rotation * points.positions_mm[k] + bone_from_marker.translation_mm;
      };
      if (i + kAhead < points.positions_mm.size()) field.expect(there(i + kAhead));
      const Eigen::Vector3d p = there(i);
      const DistanceField::Sample sample = field.sample(p);
      const double ratio = width * width / (width * width + sample.distance_mm * sample.distance_mm);
      cost += points.weights[i] * (1 - ratio);
      equations.add(p - pivot, sample.gradient, sample.distance_mm, points.weights[i] * ratio * ratio);
    }
    approached.cost = cost / std::max(points.weight_sum, 1e-9);
    const Vector6d twist = equations.solve();
    move(bone_from_marker, twist, pivot);
    if (progress == 1.0 && is_small(twist)) break;
  }
  return approached;
}

RefinedPose refine(const DistanceField& field, const WeightedPoints& points, const RigidTransform& start,
                   const NoiseModel& model, const MarkerPrior& prior, int iterations) {
  const auto distance = [&field](const Eigen::Vector3d& p) { return field.sample(p); };
  const auto expect = [&field](const Eigen::Vector3d& p) { field.expect(p); };
  return refine_by(distance, expect, points, start, model, prior, iterations);
}

RefinedPose refine(const DistanceFunction& distance, const WeightedPoints& points,
                   const RigidTransform& start, const NoiseModel& model, const MarkerPrior& prior,
                   int iterations) {
  return refine_by(
      distance, [](const Eigen::Vector3d&) {}, points, start, model, prior, iterations);
}

}  // namespace arthronaut::registration
