#include "planning/postop/fit_spread.h"

#include <Eigen/LU>
#include <algorithm>

namespace arthronaut::postop {

namespace {

// Of a variance, over what parts of the picture tell of it.
constexpr double kUntold = 1.5;

}  // namespace

FitSpread spread_of(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& by_part) {
  double disagreement = 0, numbers = 0;
  for (Eigen::Index n = 0; n < normal.rows(); ++n) {
    const double of_number = by_part.row(n).squaredNorm();
    if (!(of_number > 0)) continue;  // a stretch that nothing is seen of
    disagreement += of_number / normal(n, n);
    numbers += 1;
  }
  const auto parts = static_cast<double>((by_part.colwise().squaredNorm().array() > 0).count());
  FitSpread spread;
  spread.shared_voxels =
      std::max(1.0, disagreement / std::max(1.0, numbers) * parts / std::max(1.0, parts - numbers));
  const Eigen::MatrixXd inverse = normal.inverse();
  spread.by_noise = kUntold * spread.shared_voxels * inverse;
  spread.by_disagreement = inverse * by_part * by_part.transpose() * inverse;
  return spread;
}

}  // namespace arthronaut::postop
