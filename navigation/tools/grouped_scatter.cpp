#include "navigation/tools/grouped_scatter.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace arthronaut::tools {

PoseGroups group_by_orientation(std::span<const Eigen::Matrix3d> rotations, const std::vector<bool>& use,
                                double step_rad) {
  PoseGroups groups;
  groups.group_of.assign(rotations.size(), PoseGroups::kNone);
  std::vector<const Eigen::Matrix3d*> first;
  // The trace of A^T B is 1 + 2 cos(angle).
  const double least_trace = 1 + 2 * std::cos(step_rad);
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (!use[i]) continue;
    std::size_t group = 0;
    while (group < first.size() && first[group]->cwiseProduct(rotations[i]).sum() <= least_trace) ++group;
    if (group == first.size()) first.push_back(&rotations[i]);
    groups.group_of[i] = group;
  }
  groups.count = first.size();
  return groups;
}

Eigen::MatrixXd GroupedScatter::covariance(const Eigen::MatrixXd& information, double equations) const {
  const auto unknowns = information.rows();
  const double count = static_cast<double>(groups_.count), taken = static_cast<double>(unknowns) / equations;
  if (count <= taken)
    return Eigen::MatrixXd::Constant(unknowns, unknowns, std::numeric_limits<double>::infinity());
  const Eigen::MatrixXd inverse = information.inverse();
  return inverse * (sums_ * sums_.transpose()) * inverse * (count / (count - taken));
}

}  // namespace arthronaut::tools
