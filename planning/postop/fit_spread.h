// How far the numbers of a weighted least-squares fit to voxels may be off: by what parts of the picture tell
// differently. Inner header of postop.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace arthronaut::postop {

struct FitSpread {
  // Covariances of the numbers. By the noise, as much of it shared by neighbouring voxels as `shared_voxels`
  // says; and by how far the numbers move when any one of the parts is left out (the jackknife, less what
  // the others move by for their being fewer), which is the surer the more parts there are.
  Eigen::MatrixXd by_noise, by_disagreement;
  double shared_voxels = 1;  // at least 1
  double freedom = 1;        // parts less numbers, at least 1: how well either covariance is known
};

// What one part of the picture alone puts into both sides of the normal equations, at the solution.
struct PartOfFit {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
};

// normal: of the fit, its weights one over the variance of a voxel. Parts are to be larger than grain and
// blur. How far they disagree is pooled over all numbers for the noise, of which each takes some of what they
// could disagree in; that grain may be larger than a part, and levels that are assumed none, adds half of the
// variance, as in trials. Not finite where the normal matrix, or that of all parts but one, has no inverse.
[[nodiscard]] FitSpread spread_of(const Eigen::MatrixXd& normal, const std::vector<PartOfFit>& parts);

// The most that one sigma of an error in a plane (the root of the mean of its square) may be so that it is
// beyond `limit` no more often than `chance`; less where the sigma is itself known only to so much freedom
// (Student's t in two dimensions).
[[nodiscard]] double largest_sigma(double limit, double chance, double freedom);

}  // namespace arthronaut::postop
