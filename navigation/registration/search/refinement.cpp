#include "navigation/registration/search/refinement.h"

#include <algorithm>
#include <cmath>

#include "navigation/registration/search/pose_step.h"

namespace arthronaut::registration {

namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

bool is_small(const Vector6d& twist) {
  return twist.head<3>().norm() < 1e-4 && twist.tail<3>().norm() < 1e-5;
}

// How many points before its turn one is expected by the field: about what a look-up in main memory lasts.
constexpr std::size_t kAhead = 6;

}  // namespace

MarkerObjection object_to(const Eigen::Matrix3d& bone_from_marker, const DistanceField::Sample& sample,
                          const MarkerPrior& prior) {
  constexpr double kWidth = 9.0;  // squared, in sigmas
  const double miss = (sample.distance_mm - prior.height_mm) / prior.sigma_mm;
  const double tilt_rad = geometry::angle_between_rad(bone_from_marker.col(2), sample.gradient);
  const double excess = std::max(0.0, tilt_rad - prior.free_tilt_rad) / prior.tilt_sigma_rad;
  const double ratio = kWidth / (kWidth + miss * miss);
  const auto robust = [](double square) { return 0.5 * kWidth * square / (kWidth + square); };
  return {robust(miss * miss) + robust(excess * excess), ratio * ratio / (prior.sigma_mm * prior.sigma_mm)};
}

RefinedPose refine(const DistanceField& field, const WeightedPoints& points, const RigidTransform& start,
                   const NoiseModel& model, const MarkerPrior& prior, int iterations) {
  RefinedPose refined;
  refined.bone_from_marker = start;
  refined.model = model;
  refined.residuals_mm.resize(points.positions_mm.size());
  for (int iteration = 0;; ++iteration) {
    const bool is_last = iteration >= iterations;  // where the pose stays: its cost and residuals alone
    const Eigen::Vector3d pivot = refined.bone_from_marker * points.centroid_mm;
    const Eigen::Matrix3d rotation = refined.bone_from_marker.matrix();
    const Explainer explainer(refined.model);
    NormalEquations equations;
    ModelUpdate model_update;
    double cost = 0;
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      const auto there = [&](std::size_t k) -> Eigen::Vector3d {
        return rotation * points.positions_mm[k] + refined.bone_from_marker.translation_mm;
      };
      if (i + kAhead < points.positions_mm.size()) field.expect(there(i + kAhead));
      const Eigen::Vector3d p = there(i);
      const DistanceField::Sample sample = field.sample(p);
      const double residual_mm = sample.distance_mm - points.offset_mm(i);
      refined.residuals_mm[i] = residual_mm;
      const ByExplanation joint = explainer.shares() * explainer.densities_per_mm(residual_mm);
      const double density_per_mm = joint.sum();
      cost -= points.weights[i] * std::log(density_per_mm);
      if (is_last) continue;
      const ByExplanation probabilities = (1 / density_per_mm) * joint;
      model_update.add(probabilities, residual_mm, points.weights[i]);
      const auto [information, miss_mm] = explainer.pull_of(residual_mm, probabilities);
      if (information < 1e-9) continue;
      equations.add(row_of(sample.gradient, p - pivot), miss_mm, points.weights[i] * information);
    }
    if (prior.use) {
      const Eigen::Vector3d& marker = refined.bone_from_marker.translation_mm;
      const DistanceField::Sample sample = field.sample(marker);
      const MarkerObjection objection = object_to(rotation, sample, prior);
      equations.add(row_of(sample.gradient, marker - pivot), sample.distance_mm - prior.height_mm,
                    kCorrelationLength_mm * objection.information);
      cost += kCorrelationLength_mm * objection.cost;
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
      equations.add(row_of(sample.gradient, p - pivot), sample.distance_mm,
                    points.weights[i] * ratio * ratio);
    }
    approached.cost = cost / std::max(points.weight_sum, 1e-9);
    const Vector6d twist = equations.solve();
    move(bone_from_marker, twist, pivot);
    if (progress == 1.0 && is_small(twist)) break;
  }
  return approached;
}

}  // namespace arthronaut::registration
