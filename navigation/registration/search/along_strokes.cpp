#include "navigation/registration/search/along_strokes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/registration/search/pose_step.h"

namespace arthronaut::registration {

namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kKnotSpacing_mm = 8;  // between knots of the slow error
constexpr double kStay_mm = 16;        // of path that the tip goes on as it is, in the mean
// The white noise as it is measured, about a curve that goes along with a part of it, is too small; and what
// is left of the slow error between knots is to be borne too.
constexpr double kOfMeasuredNoise = 1.5;

bool begins_stroke(const WeightedPoints& points, std::size_t i) {
  return i == 0 || points.path_mm[i] <= points.path_mm[i - 1];
}

// The mesh itself, where the field knows the sign; the two agree about it but within the grid's rounding.
DistanceField::Sample exact_sample(const SurfaceIndex::Data& bone, const Eigen::Vector3d& p) {
  DistanceField::Sample sample = bone.field.sample(p);
  if (std::abs(sample.distance_mm) >= bone.field.band_mm()) return sample;
  const Eigen::Vector3d away = p - bone.surface.closest_point(p).point_mm;
  sample.distance_mm = (away.dot(sample.gradient) < 0 ? -1.0 : 1.0) * away.norm();
  return sample;
}

// Between which knots of the slow error a point lies: the one named and the next.
struct Place {
  std::size_t knot;
  double share_of_next;
};

// Knots of all strokes in a row. Least squares for them and the pose together, where each knot meets but its
// neighbours and the pose: they are eliminated one by one.
class SlowError {
 public:
  SlowError(const WeightedPoints& points, double sigma_mm) {
    for (std::size_t first = 0; first < points.path_mm.size();) {
      std::size_t last = first + 1;
      while (last < points.path_mm.size() && !begins_stroke(points, last)) ++last;
      const double begin_mm = points.path_mm[first], length_mm = points.path_mm[last - 1] - begin_mm;
      const auto intervals = static_cast<std::size_t>(std::max(1.0, std::ceil(length_mm / kKnotSpacing_mm)));
      for (std::size_t i = first; i < last; ++i) {
        const double at = length_mm > 0
                              ? static_cast<double>(intervals) * ((points.path_mm[i] - begin_mm) / length_mm)
                              : 0.0;
        const std::size_t knot = std::min(static_cast<std::size_t>(at), intervals - 1);
        places_.push_back({knots_.size() + knot, at - static_cast<double>(knot)});
      }
      knots_.resize(knots_.size() + intervals + 1);
      first = last;
    }
    // Between knots the error is smaller than at them, by a third of its variance in the mean.
    information_ = 1 / (1.5 * sigma_mm * sigma_mm);
    begin();
  }

  [[nodiscard]] Eigen::Vector3d at(std::size_t point) const {
    const auto [knot, next] = places_[point];
    return (1 - next) * knots_[knot].error_mm + next * knots_[knot + 1].error_mm;
  }
  // As NormalEquations::add, of a residual less the slow error.
  void add(std::size_t point, const Eigen::Vector3d& gradient, const Vector6d& row, double residual_mm,
           double weight) {
    const auto [knot, next] = places_[point];
    Knot &a = knots_[knot], &b = knots_[knot + 1];
    const Eigen::Matrix3d square = weight * gradient * gradient.transpose();
    const Eigen::Matrix<double, 3, 6> by_pose = weight * gradient * row.transpose();
    const Eigen::Vector3d pull = weight * residual_mm * gradient;
    a.matrix += (1 - next) * (1 - next) * square;
    b.matrix += next * next * square;
    a.by_next += (1 - next) * next * square;
    a.by_pose -= (1 - next) * by_pose;
    b.by_pose -= next * by_pose;
    a.right += (1 - next) * pull;
    b.right += next * pull;
  }
  // Leaves in the pose's equations what they say whatever the knots are.
  void eliminate_from(NormalEquations& pose) {
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      Knot& knot = knots_[k];
      const Eigen::Matrix3d inverse = knot.matrix.inverse();
      const Eigen::Matrix<double, 3, 6> by_pose = inverse * knot.by_pose;
      const Eigen::Matrix3d by_next = inverse * knot.by_next;
      const Eigen::Vector3d right = inverse * knot.right;
      pose.matrix -= knot.by_pose.transpose() * by_pose;
      pose.right -= knot.by_pose.transpose() * right;
      if (k + 1 < knots_.size()) {
        Knot& next = knots_[k + 1];
        next.matrix -= knot.by_next.transpose() * by_next;
        next.by_pose -= knot.by_next.transpose() * by_pose;
        next.right -= knot.by_next.transpose() * right;
      }
      knot.by_pose = by_pose;
      knot.by_next = by_next;
      knot.right = right;
    }
  }
  // The knots' own step, once the pose's is known; and from there anew.
  void step(const Vector6d& twist) {
    Eigen::Vector3d next_step = Eigen::Vector3d::Zero();
    for (std::size_t k = knots_.size(); k-- > 0;) {
      Knot& knot = knots_[k];
      next_step = knot.right - knot.by_pose * twist - knot.by_next * next_step;
      knot.error_mm += next_step;
    }
    begin();
  }

 private:
  struct Knot {
    Eigen::Vector3d error_mm = Eigen::Vector3d::Zero();
    Eigen::Matrix3d matrix, by_next;
    Eigen::Matrix<double, 3, 6> by_pose;
    Eigen::Vector3d right;
  };

  void begin() {
    for (Knot& knot : knots_) {
      knot.matrix = information_ * Eigen::Matrix3d::Identity();
      knot.by_next.setZero();
      knot.by_pose.setZero();
      knot.right = -information_ * knot.error_mm;
    }
  }

  std::vector<Knot> knots_;
  std::vector<Place> places_;  // by point
  double information_ = 0;
};

// How each point was met, from the densities of its residual under each explanation; these are overwritten.
void smooth_along(const WeightedPoints& points, const ByExplanation& shares,
                  std::vector<ByExplanation>& densities) {
  const auto normalised = [](const ByExplanation& p) { return (1 / p.sum()) * p; };
  const auto stay_to = [&](std::size_t i) {
    return begins_stroke(points, i) ? 0 : std::exp((points.path_mm[i - 1] - points.path_mm[i]) / kStay_mm);
  };
  const std::size_t count = densities.size();
  std::vector<ByExplanation> forwards(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double stay = stay_to(i);
    const ByExplanation expected = i == 0 ? shares : stay * forwards[i - 1] + (1 - stay) * shares;
    forwards[i] = normalised(expected * densities[i]);
  }
  ByExplanation backwards{1, 1, 1};
  for (std::size_t i = count; i-- > 0;) {
    const double stay = stay_to(i);
    const ByExplanation here = densities[i] * backwards;
    densities[i] = normalised(forwards[i] * backwards);
    const double otherwise = (1 - stay) * (shares * here).sum();
    backwards = normalised(stay * here + ByExplanation{otherwise, otherwise, otherwise});
  }
}

}  // namespace

RigidTransform fit_along_strokes(const SurfaceIndex::Data& bone, const WeightedPoints& points,
                                 const RefinedPose& start, const MarkerPrior& prior,
                                 const AlongStrokesOptions& options) {
  const std::size_t count = points.positions_mm.size();
  NoiseModel white = start.model;
  white.contact_sigma_mm = std::clamp(kOfMeasuredNoise * options.white_noise_mm, kMinSigma_mm, kMaxSigma_mm);
  const double square = white.contact_sigma_mm * white.contact_sigma_mm;
  const double slow_mm =
      std::sqrt(std::max(start.model.contact_sigma_mm * start.model.contact_sigma_mm - square, square / 4));
  SlowError slow(points, slow_mm);
  RigidTransform bone_from_marker = start.bone_from_marker;
  std::vector<DistanceField::Sample> samples(count);
  std::vector<ByExplanation> probabilities(count);
  for (int k = 0; k < options.iterations_by_field + options.iterations_by_mesh; ++k) {
    const bool by_mesh = k >= options.iterations_by_field;
    const Eigen::Vector3d pivot = bone_from_marker * points.centroid_mm;
    const Eigen::Matrix3d rotation = bone_from_marker.matrix();
    const auto there = [&](std::size_t i) -> Eigen::Vector3d {
      return rotation * points.positions_mm[i] + bone_from_marker.translation_mm;
    };
    const Explainer explainer(white);
    for (std::size_t i = 0; i < count; ++i) {
      samples[i] = by_mesh ? exact_sample(bone, there(i)) : bone.field.sample(there(i));
      samples[i].distance_mm -= points.offset_mm(i) + samples[i].gradient.dot(slow.at(i));
      probabilities[i] = explainer.densities_per_mm(samples[i].distance_mm);
    }
    smooth_along(points, explainer.shares(), probabilities);

    NormalEquations equations;
    ModelUpdate shares;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [residual_mm, gradient] = samples[i];
      shares.add(probabilities[i], residual_mm, points.weights[i]);
      const auto [information, miss_mm] = explainer.pull_of(residual_mm, probabilities[i]);
      const Vector6d row = row_of(gradient, there(i) - pivot);
      equations.add(row, miss_mm, information);
      slow.add(i, gradient, row, miss_mm, information);
    }
    if (prior.use) {
      const Eigen::Vector3d& marker = bone_from_marker.translation_mm;
      const DistanceField::Sample sample = bone.field.sample(marker);
      equations.add(row_of(sample.gradient, marker - pivot), sample.distance_mm - prior.height_mm,
                    object_to(rotation, sample, prior).information);
    }
    slow.eliminate_from(equations);
    const Vector6d twist = equations.solve();
    move(bone_from_marker, twist, pivot);
    slow.step(twist);
    const NoiseModel updated = shares.updated(white);
    white.soft_share = updated.soft_share;
    white.lifted_share = updated.lifted_share;
  }
  return bone_from_marker;
}

}  // namespace arthronaut::registration
