#include "planning/postop/fit_spread.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arthronaut::postop {

namespace {

// Of a variance, over what parts of the picture tell of it.
constexpr double kUntold = 1.5;

}  // namespace

FitSpread spread_of(const Eigen::MatrixXd& normal, const std::vector<PartOfFit>& parts) {
  Eigen::VectorXd disagreement = Eigen::VectorXd::Zero(normal.rows());
  FitSpread spread;
  spread.by_disagreement = Eigen::MatrixXd::Zero(normal.rows(), normal.cols());
  double told = 0;
  for (const PartOfFit& part : parts) {
    if (!(part.right.squaredNorm() > 0)) continue;  // nothing is seen of it
    told += 1;
    disagreement += part.right.cwiseAbs2();
    const Eigen::VectorXd moved = (normal - part.normal).ldlt().solve(part.right);
    spread.by_disagreement += moved * moved.transpose();
  }
  const auto numbers = static_cast<double>((disagreement.array() > 0).count());
  spread.freedom = std::max(1.0, told - numbers);
  // The others move by more when one is left out than all of them are off, as each takes its share of the
  // numbers.
  spread.by_disagreement *= spread.freedom / std::max(1.0, told);
  const double pooled = (disagreement.array() / normal.diagonal().array()).sum() / std::max(1.0, numbers);
  spread.shared_voxels = std::max(1.0, pooled * told / spread.freedom);
  spread.by_noise = kUntold * spread.shared_voxels * normal.inverse();
  return spread;
}

double largest_sigma(double limit, double chance, double freedom) {
  return limit / std::sqrt(0.5 * freedom * (std::pow(chance, -2 / freedom) - 1));
}

}  // namespace arthronaut::postop
