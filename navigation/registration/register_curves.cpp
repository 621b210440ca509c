#include <algorithm>
#include <cmath>
#include <random>

#include "navigation/registration/confidence.h"
#include "navigation/registration/curve_checks.h"
#include "navigation/registration/curve_registration.h"
#include "navigation/registration/global_search.h"
#include "navigation/registration/pose_pool.h"
#include "navigation/registration/registration.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

namespace {

constexpr int kMaxRounds = 7, kMirrorRounds = 2;

// How much better the best pose explains the points than the best different one, in units of independent measurements.
double lead_of(const PosePool& pool, const TouchedPoints& points) {
  if (pool.empty()) return 0;
  constexpr double kNoRival = 100;
  if (pool.runner_up() == nullptr) return kNoRival;
  return (pool.runner_up()->cost - pool.best().cost) * points.weight_sum / kCorrelationLength_mm;
}

// Starts around a pose, some millimetres and degrees away: a rival that lies near it is easily missed by the search, and
// is the one that a small residual hides best.
std::vector<Hypothesis> neighbours_of(const geometry::RigidTransform& bone_from_marker,
                                      const Eigen::Vector3d& centroid_mm, std::uint64_t seed) {
  constexpr int kCount = 24;
  constexpr double kDistance_mm = 6, kAngle_rad = 0.35;
  std::mt19937_64 random(seed);
  const auto vector = [&random](double length) {
    const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
    Eigen::Vector3d v;
    do v = {uniform(), uniform(), uniform()};
    while (v.squaredNorm() > 1);
    return Eigen::Vector3d(length * v);
  };
  const Eigen::Vector3d center = bone_from_marker * centroid_mm;
  std::vector<Hypothesis> neighbours(kCount);
  for (Hypothesis& neighbour : neighbours) {
    const Eigen::Vector3d turn = vector(kAngle_rad);
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    neighbour.bone_from_marker.rotation = rotation * bone_from_marker.rotation;
    neighbour.bone_from_marker.translation_mm =
        center + vector(kDistance_mm) + rotation * (bone_from_marker.translation_mm - center);
  }
  return neighbours;
}

// The curves as they would be had the bone been its own mirror image. The marker's face stays its face.
strokes::Curves mirrored(strokes::Curves curves) {
  for (strokes::CurvePoint& point : curves) point.position_mm.x() = -point.position_mm.x();
  return curves;
}

}  // namespace

RegistrationSummary search_and_summarise(const PreparedBone::Data& bone, const strokes::Curves& curves,
                                         const RegistrationOptions& options, int max_rounds) {
  constexpr std::size_t kPointCount = 800;
  constexpr int kPairsEachRound = 8, kIterationsEachRound = 5, kFinalIterations = 12;
  constexpr std::size_t kHypothesesEachRound = 24;
  // Found beyond doubt: no need to search on.
  constexpr double kClearLead = 25, kClearLeadLater = 12;

  const TouchedPoints points = choose_points(curves, kPointCount);
  const std::vector<strokes::OrientedPoint> oriented = strokes::oriented_points(curves);
  MarkerPrior prior;
  prior.use = options.use_marker_prior;
  PosePool pool(bone, prior);
  for (int round = 0; round < max_rounds; ++round) {
    const std::uint64_t seed = options.seed * kMaxRounds + static_cast<std::uint64_t>(round);
    pool.add(search_globally(bone, oriented, points,
                             {seed, options.use_marker_prior, kPairsEachRound, kHypothesesEachRound}),
             points, seed);
    pool.refine_all(points, kIterationsEachRound);
    if (lead_of(pool, points) > (round == 0 ? kClearLead : kClearLeadLater)) break;
  }
  if (!pool.empty()) {
    const std::uint64_t seed = options.seed * kMaxRounds;
    pool.add(neighbours_of(pool.best().bone_from_marker, points.centroid_mm, seed), points, seed);
    pool.refine_all(points, kFinalIterations);
    pool.polish(points);
  }
  return summarise(bone, pool, {curves, points, strokes::stroke_length_mm(curves), white_noise_of(oriented)}, options);
}

bool mirror_image_fits_better(const PreparedBone::Data& bone, const strokes::Curves& curves,
                              const RegistrationOptions& options, const RegistrationSummary& found) {
  const RegistrationSummary image = search_and_summarise(bone, mirrored(curves), options, kMirrorRounds);
  return image.reliable && image.misfit_mm < found.misfit_mm;
}

RegistrationSummary register_curves(const PreparedBone& prepared, const strokes::Curves& curves,
                                    const RegistrationOptions& options) {
  const PreparedBone::Data& bone = prepared.data();
  RegistrationSummary summary;
  summary.point_count = static_cast<int>(curves.size());
  summary.reasons = objections_to(curves, bone.bounds.size_mm().norm());
  if (!summary.reasons.empty()) return summary;

  summary = search_and_summarise(bone, curves, options, kMaxRounds);
  if (!summary.reliable && mirror_image_fits_better(bone, curves, options, summary)) {
    summary.reasons.insert(summary.reasons.begin(), std::string(kOtherSideReason));
  }
  return summary;
}

double predicted_error_mm(const RegistrationSummary& registration, const Eigen::Vector3d& point_in_bone_mm) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(point_in_bone_mm);
  return std::sqrt(std::max(0.0, (move * registration.covariance * move.transpose()).trace()));
}

}  // namespace arthronaut::registration
