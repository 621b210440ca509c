// How far the numbers of a weighted least-squares fit to voxels may be off: by what parts of the picture tell
// differently. Inner header of postop.
#pragma once

#include <Eigen/Core>

namespace arthronaut::postop {

struct FitSpread {
  // Covariances of the numbers. By the noise, as much of it shared by neighbouring voxels as `shared_voxels`
  // says; and by how far the parts disagree in each number, which is the surer the more parts there are.
  Eigen::MatrixXd by_noise, by_disagreement;
  double shared_voxels = 1;  // at least 1
};

// normal: of the fit, its weights one over the variance of a voxel. by_part: what each part of the picture
// alone puts into the right side at the solution, as columns; parts are to be larger than grain and blur. How
// far they disagree is pooled over all numbers, of which each takes some of what they could disagree in; that
// grain may be larger than a part, and levels that are assumed none, adds half of the variance, as in trials.
// Not finite where the normal matrix has no inverse.
[[nodiscard]] FitSpread spread_of(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& by_part);

}  // namespace arthronaut::postop
