#include "navigation/registration/covered_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace arthronaut::registration {

namespace {

constexpr double kThinnest_mm = -4, kThickest_mm = 5, kStep_mm = 0.25;
constexpr int kIterations = 6, kFinalIterations = 15;
// The thickness is held when it is known this well, and enough was touched on both sides of the border.
constexpr double kMaxSigma_mm = 0.4, kMinMeasurements = 4;

bool is_covered(const CoveredRegion& region, const Eigen::Vector3d& point_mm) {
  return std::any_of(region.points_mm.begin(), region.points_mm.end(), [&](const Eigen::Vector3d& p) {
    return (p - point_mm).squaredNorm() < region.reach_mm * region.reach_mm;
  });
}

class Fit {
 public:
  Fit(const PreparedBone::Data& bone, const TouchedPoints& points, const RefinedPose& pose, const CoveredRegion& region,
      const MarkerPrior& prior)
      : bone_(bone), points_(points), start_(pose), prior_(prior) {
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      covered_.push_back(is_covered(region, pose.bone_from_marker * points.positions_mm[i]));
      (covered_.back() ? covered_sum_ : bare_sum_) += points.weights[i];
    }
  }

  [[nodiscard]] bool touches_both() const {
    return std::min(covered_sum_, bare_sum_) > kMinMeasurements * kCorrelationLength_mm;
  }
  [[nodiscard]] bool touches_bare() const { return bare_sum_ > kMinMeasurements * kCorrelationLength_mm; }
  [[nodiscard]] bool touches_cover() const { return covered_sum_ > 0; }

  [[nodiscard]] RefinedPose at(double thickness_mm, int iterations) const {
    return refined(points_at(thickness_mm), iterations);
  }
  [[nodiscard]] RefinedPose refined(const TouchedPoints& points, int iterations) const {
    return refine([this](const Eigen::Vector3d& p) { return bone_.field.sample(p); }, points, start_.bone_from_marker,
                  start_.model, prior_, iterations);
  }
  [[nodiscard]] TouchedPoints points_at(double thickness_mm) const {
    TouchedPoints points = points_;
    points.offsets_mm.assign(points.positions_mm.size(), 0.0);
    for (std::size_t i = 0; i < covered_.size(); ++i) {
      if (covered_[i]) points.offsets_mm[i] = thickness_mm;
    }
    return points;
  }
  [[nodiscard]] TouchedPoints bare_points() const {
    TouchedPoints bare;
    for (std::size_t i = 0; i < covered_.size(); ++i) {
      if (covered_[i]) continue;
      bare.positions_mm.push_back(points_.positions_mm[i]);
      bare.weights.push_back(points_.weights[i]);
      bare.stretches.push_back(points_.stretches[i]);
      bare.weight_sum += points_.weights[i];
      bare.centroid_mm += points_.weights[i] * points_.positions_mm[i];
    }
    if (bare.weight_sum > 0) bare.centroid_mm /= bare.weight_sum;
    return bare;
  }
  // Negative log likelihood in independent measurements.
  [[nodiscard]] double loss(const RefinedPose& pose) const {
    return pose.cost * points_.weight_sum / kCorrelationLength_mm;
  }

 private:
  const PreparedBone::Data& bone_;
  const TouchedPoints& points_;
  const RefinedPose& start_;
  MarkerPrior prior_;
  std::vector<bool> covered_;
  double covered_sum_ = 0, bare_sum_ = 0;
};

std::string formatted(const char* format, double first, double second) {
  char text[160];
  std::snprintf(text, sizeof text, format, first, second);
  return text;
}

}  // namespace

CoverFit fit_cover(const PreparedBone::Data& bone, const TouchedPoints& points, const RefinedPose& pose,
                   const CoveredRegion& region, const MarkerPrior& prior) {
  const Fit fit(bone, points, pose, region, prior);
  CoverFit result;
  result.pose = pose;
  result.points = points;
  if (!fit.touches_cover()) {
    result.assumption = "no stroke lies on the covered region";
    return result;
  }
  if (!fit.touches_bare()) {
    result.has_bare = false;
    result.assumption = "the covered region was taken to lie on the mesh: nothing but it was touched";
    return result;
  }
  double best_loss = 1e18;
  if (fit.touches_both()) {
    for (double thickness = kThinnest_mm; thickness <= kThickest_mm; thickness += kStep_mm) {
      const double loss = fit.loss(fit.at(thickness, kIterations));
      if (loss >= best_loss) continue;
      best_loss = loss;
      result.thickness_mm = thickness;
    }
    // A parabola through the likelihood around the best gives its place and its width.
    const std::array<RefinedPose, 3> near{fit.at(result.thickness_mm - kStep_mm, kFinalIterations),
                                          fit.at(result.thickness_mm, kFinalIterations),
                                          fit.at(result.thickness_mm + kStep_mm, kFinalIterations)};
    const double before = fit.loss(near[0]), here = fit.loss(near[1]), after = fit.loss(near[2]);
    const double curvature = (before - 2 * here + after) / (kStep_mm * kStep_mm);
    const bool is_inside = result.thickness_mm > kThinnest_mm && result.thickness_mm < kThickest_mm;
    if (curvature > 0 && is_inside) {
      result.thickness_mm += std::clamp(0.5 * (before - after) / (curvature * kStep_mm), -kStep_mm, kStep_mm);
      result.sigma_mm = 1 / std::sqrt(curvature);
      result.drift_per_mm = geometry::log(near[2].bone_from_marker * near[0].bone_from_marker.inverse()) / (2 * kStep_mm);
      result.is_solved = result.sigma_mm < kMaxSigma_mm;
    }
  }
  if (result.is_solved) {
    result.points = fit.points_at(result.thickness_mm);
    result.assumption = formatted("the covered region lies %.1f mm off the mesh, one sigma %.1f mm: solved from the strokes",
                                  result.thickness_mm, result.sigma_mm);
  } else {
    result.points = fit.bare_points();
    result.assumption = "the covered region was left out: the strokes don't hold its thickness";
  }
  result.pose = fit.refined(result.points, kFinalIterations);
  return result;
}

}  // namespace arthronaut::registration
