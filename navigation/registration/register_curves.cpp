#include <algorithm>
#include <cmath>

#include "navigation/registration/confidence.h"
#include "navigation/registration/global_search.h"
#include "navigation/registration/prepared_bone.h"
#include "navigation/registration/refinement.h"
#include "navigation/registration/registration.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

namespace {

using geometry::RigidTransform;

constexpr std::size_t kCoarsePointCount = 120, kFinePointCount = 800;
constexpr std::size_t kFineHypothesisCount = 8;

DistanceFunction distance_in(const DistanceField& field) {
  return [&field](const Eigen::Vector3d& p) { return field.sample(p); };
}

// The grid rounds off what lies between its nodes; the mesh itself has the last word.
DistanceFunction distance_to(const geometry::Surface& surface) {
  return [&surface](const Eigen::Vector3d& p) {
    const geometry::SurfacePoint nearest = surface.closest_point(p);
    DistanceField::Sample sample;
    sample.distance_mm = surface.signed_distance_mm(p);
    const Eigen::Vector3d away = p - nearest.point_mm;
    // At the surface itself the direction to it is noise.
    sample.gradient = std::abs(sample.distance_mm) > 1e-3 ? Eigen::Vector3d(away / sample.distance_mm) : nearest.normal;
    return sample;
  };
}

// Poses that put the touched area elsewhere, not refinements of the same.
bool differs(const RigidTransform& a, const RigidTransform& b, const Eigen::Vector3d& where_mm) {
  constexpr double kDistance_mm = 3.0, kAngle_deg = 5.0;
  return (a * where_mm - b * where_mm).norm() > kDistance_mm ||
         geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation)) > kAngle_deg;
}

std::vector<RefinedPose> refine_hypotheses(const PreparedBone::Data& bone, const TouchedPoints& points,
                                           const std::vector<Hypothesis>& hypotheses, const MarkerPrior& prior,
                                           std::uint64_t seed) {
  const TouchedPoints coarse_points = draw_points(points, kCoarsePointCount, seed);
  std::vector<RefinedPose> poses;
  for (const Hypothesis& hypothesis : hypotheses) {
    const RigidTransform near = approach(bone.field, coarse_points, hypothesis.bone_from_marker);
    poses.push_back(refine(distance_in(bone.field), coarse_points, near, {}, prior, 6));
  }
  const auto by_cost = [](const RefinedPose& l, const RefinedPose& r) { return l.cost < r.cost; };
  std::sort(poses.begin(), poses.end(), by_cost);
  std::vector<RefinedPose> fine;
  for (const RefinedPose& pose : poses) {
    if (fine.size() == kFineHypothesisCount) break;
    const bool is_new = std::all_of(fine.begin(), fine.end(), [&](const RefinedPose& other) {
      return differs(pose.bone_from_marker, other.bone_from_marker, points.centroid_mm);
    });
    if (is_new) fine.push_back(refine(distance_in(bone.field), points, pose.bone_from_marker, pose.model, prior, 15));
  }
  std::sort(fine.begin(), fine.end(), by_cost);
  return fine;
}

}  // namespace

RegistrationSummary register_curves(const PreparedBone& prepared, const strokes::Curves& curves,
                                    const RegistrationOptions& options) {
  const PreparedBone::Data& bone = prepared.data();
  RegistrationSummary summary;
  summary.point_count = static_cast<int>(curves.size());

  const std::vector<strokes::OrientedPoint> oriented = strokes::oriented_points(curves);
  const TouchedPoints points = choose_points(curves, kFinePointCount);
  MarkerPrior prior;
  prior.use = options.use_marker_prior;
  const std::vector<Hypothesis> hypotheses =
      search_globally(bone, oriented, points, {options.seed, options.use_marker_prior});
  if (hypotheses.empty()) {
    summary.reasons = {"no pose was found that puts the touched curves on this bone"};
    return summary;
  }
  const std::vector<RefinedPose> poses = refine_hypotheses(bone, points, hypotheses, prior, options.seed);
  RefinedPose best = poses.front();
  best = refine(distance_to(bone.surface), points, best.bone_from_marker, best.model, prior, 4);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!differs(best.bone_from_marker, poses[i].bone_from_marker, points.centroid_mm)) continue;
    summary.runner_up_ratio = std::exp(poses[i].cost - best.cost);
    break;
  }
  if (summary.runner_up_ratio == 0) summary.runner_up_ratio = 10;

  summary.has_pose = true;
  summary.marker_from_bone = best.bone_from_marker.inverse();
  summary.covariance = covariance_of(best, points, bone, prior);
  summary.predicted_tre_mm = predicted_error_mm(
      summary, options.target_in_bone_mm.value_or(best.bone_from_marker * points.centroid_mm));
  for (const strokes::CurvePoint& point : curves) {
    summary.point_residuals_mm.push_back(
        bone.surface.signed_distance_mm(best.bone_from_marker * point.position_mm));
  }
  judge(best, points, strokes::stroke_length_mm(curves), summary);
  return summary;
}

double predicted_error_mm(const RegistrationSummary& registration, const Eigen::Vector3d& point_in_bone_mm) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(point_in_bone_mm);
  return std::sqrt(std::max(0.0, (move * registration.covariance * move.transpose()).trace()));
}

}  // namespace arthronaut::registration
