#include "navigation/registration/search/pose_pool.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace arthronaut::registration {

namespace {

using geometry::RigidTransform;

constexpr std::size_t kFewPoints = 60, kCoarsePointCount = 120;
constexpr std::size_t kPoolSize = 8;
constexpr int kIterationsToJudge = 2;

}  // namespace

double lead_of(double cost, double rival_cost, const WeightedPoints& points) {
  return (rival_cost - cost) * points.weight_sum / kCorrelationLength_mm;
}

bool are_different(const RigidTransform& a, const RigidTransform& b, const Eigen::Vector3d& centroid_mm) {
  constexpr double kDistance_mm = 3.0, kAngle_deg = 5.0;
  return (a * centroid_mm - b * centroid_mm).norm() > kDistance_mm ||
         geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation)) >
             kAngle_deg;
}

void PosePool::add(const std::vector<Hypothesis>& hypotheses, const WeightedPoints& points,
                   std::uint64_t seed) {
  const WeightedPoints coarse_points = draw_points(points, kCoarsePointCount, seed);
  // Those in the pool are refined on the same points, so that the costs compare.
  for (RefinedPose& pose : poses_) {
    refine_again(pose, coarse_points, 1);
  }
  for (const RigidTransform& hypothesis : most_promising(hypotheses, draw_points(points, kFewPoints, seed))) {
    const RigidTransform near = approach(bone_.field, coarse_points, hypothesis).bone_from_marker;
    poses_.push_back(refine(bone_.field, coarse_points, near, start_, prior_, 6));
    poses_.back().searches = search_bit_;
  }
  search_bit_ <<= 1;
  rank(points.centroid_mm, kPoolSize);
}

// A hypothesis is off by some degrees, so that its score says little: a few steps on few points say more, and
// let many compete. Of very many more are let through: the right one hardly ever is the first of them.
std::vector<RigidTransform> PosePool::most_promising(const std::vector<Hypothesis>& hypotheses,
                                                     const WeightedPoints& few_points) const {
  constexpr std::size_t kLeastCount = 24, kOneOf = 8;
  const std::size_t count = std::max(kLeastCount, hypotheses.size() / kOneOf);
  std::vector<ApproachedPose> approached;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypotheses.size() <= count) {
      approached.push_back({hypothesis.bone_from_marker});
    } else {
      approached.push_back(approach(bone_.field, few_points, hypothesis.bone_from_marker, {2.0, 1.4, 5}));
    }
  }
  std::stable_sort(approached.begin(), approached.end(),
                   [](const ApproachedPose& l, const ApproachedPose& r) { return l.cost < r.cost; });
  std::vector<RigidTransform> promising;
  for (std::size_t i = 0; i < std::min(count, approached.size()); ++i)
    promising.push_back(approached[i].bone_from_marker);
  return promising;
}

void PosePool::refine_all(const WeightedPoints& points, int iterations) {
  const int first_iterations = std::min(iterations, kIterationsToJudge);
  for (const int part : {first_iterations, iterations - first_iterations}) {
    if (part == 0) continue;
    for (RefinedPose& pose : poses_) refine_again(pose, points, part);
    rank(points.centroid_mm, kPoolSize);
    drop_hopeless(points);
  }
}

void PosePool::refine_again(RefinedPose& pose, const WeightedPoints& points, int iterations) const {
  const std::uint32_t searches = pose.searches;
  pose = refine(bone_.field, points, pose.bone_from_marker, pose.model, prior_, iterations);
  pose.searches = searches;
}

int PosePool::best_find_count() const { return poses_.empty() ? 0 : std::popcount(best().searches); }

void PosePool::drop_hopeless(const WeightedPoints& points) {
  constexpr double kHopeless = 25;
  while (poses_.size() > 2 && lead_of(poses_.front().cost, poses_.back().cost, points) > kHopeless)
    poses_.pop_back();
}

void PosePool::fit_best_along_strokes(const WeightedPoints& points, const AlongStrokesOptions& options) {
  poses_.front().bone_from_marker = fit_along_strokes(bone_, points, best(), prior_, options);
}

void PosePool::replace(std::vector<RefinedPose> poses, const Eigen::Vector3d& centroid_mm) {
  poses_ = std::move(poses);
  rank(centroid_mm, kPoolSize);
}

void PosePool::rank(const Eigen::Vector3d& centroid_mm, std::size_t max_count) {
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const RefinedPose& l, const RefinedPose& r) { return l.cost < r.cost; });
  std::vector<RefinedPose> kept;
  for (RefinedPose& pose : poses_) {
    if (kept.size() == max_count) break;
    const auto twin = std::find_if(kept.begin(), kept.end(), [&](const RefinedPose& other) {
      return !are_different(pose.bone_from_marker, other.bone_from_marker, centroid_mm);
    });
    if (twin == kept.end()) {
      kept.push_back(std::move(pose));
    } else {
      twin->searches |= pose.searches;
    }
  }
  poses_ = std::move(kept);
}

}  // namespace arthronaut::registration
