// The poses that compete for a set of touched points: refined, ranked, kept apart.
#pragma once

#include <optional>
#include <vector>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/along_strokes.h"
#include "navigation/registration/search/global_search.h"
#include "navigation/registration/search/refinement.h"
#include "navigation/registration/search/weighted_points.h"

namespace arthronaut::registration {

// How much better one cost explains the points than another, in independent measurements' log likelihood.
[[nodiscard]] double lead_of(double cost, double rival_cost, const WeightedPoints& points);

// Poses that put the touched area elsewhere (by more than 3 mm or 5 degrees), not refinements of one another.
[[nodiscard]] bool are_different(const geometry::RigidTransform& a, const geometry::RigidTransform& b,
                                 const Eigen::Vector3d& centroid_mm);

class PosePool {
 public:
  // start: the noise model that new poses are refined from.
  PosePool(const SurfaceIndex::Data& bone, const MarkerPrior& prior, const NoiseModel& start = {})
      : bone_(bone), prior_(prior), start_(start) {}

  // Refines hypotheses roughly on few points, and lets the best into the pool.
  void add(const std::vector<Hypothesis>& hypotheses, const WeightedPoints& points, std::uint64_t seed);
  // Refines all poses of the pool on the points, ranks them, and drops twins and all but the best few. Of
  // those that have fallen behind beyond hope only the foremost is kept, as the runner-up.
  void refine_all(const WeightedPoints& points, int iterations);
  // The last of all: see along_strokes.h. Cost and residuals stay those of the fit by points, by which poses
  // compare and their errors are predicted.
  void fit_best_along_strokes(const WeightedPoints& points, const AlongStrokesOptions& options);
  // Other poses in place of those in the pool; ranked, twins dropped.
  void replace(std::vector<RefinedPose> poses, const Eigen::Vector3d& centroid_mm);
  void clear() { poses_.clear(); }
  // How many calls of add() handed in hypotheses that led to what is the best pose now: one that was found
  // again and again is hardly missed by the next search, and neither would be a better one.
  [[nodiscard]] int best_find_count() const;

  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const RefinedPose& best() const { return poses_.front(); }
  [[nodiscard]] const std::vector<RefinedPose>& poses() const { return poses_; }
  [[nodiscard]] const MarkerPrior& prior() const { return prior_; }
  [[nodiscard]] const RefinedPose* runner_up() const { return poses_.size() > 1 ? &poses_[1] : nullptr; }

 private:
  void rank(const Eigen::Vector3d& centroid_mm, std::size_t max_count);
  [[nodiscard]] std::vector<geometry::RigidTransform> most_promising(
      const std::vector<Hypothesis>& hypotheses, const WeightedPoints& few_points) const;
  void drop_hopeless(const WeightedPoints& points);
  void refine_again(RefinedPose& pose, const WeightedPoints& points, int iterations) const;

  const SurfaceIndex::Data& bone_;
  MarkerPrior prior_;
  NoiseModel start_;
  std::uint32_t search_bit_ = 1;    // of the next call of add()
  std::vector<RefinedPose> poses_;  // best first, different from one another
};

}  // namespace arthronaut::registration
