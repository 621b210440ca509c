// How well a least squares solution is known when its residuals are alike within groups: of a tool that rests
// before the scope, the poses' errors follow the view and repeat; so do the rows of a file that holds each
// pose twice. A hundred such residuals tell no more than one of them. The covariance is then
//   N^-1 (sum over groups of s s^T) N^-1 * G / (G - k / r),   s = sum over the group of J^T residual,
// with N = sum of J^T J, G groups, k unknowns and r equations a pose (Liang and Zeger 1986, Biometrika 73,
// 10.1093/biomet/73.1.13, with the usual correction for few groups). Of independent residuals it expects
// what the usual formula does.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

// What a tracker does wrong in the same way throughout, and no number of poses averages away: places of
// markers in rendered pictures were off by two to three times what their residuals say.
inline constexpr double kSystematic_mm = 0.002, kSystematic_deg = 0.03;

struct PoseGroups {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> group_of;  // of each pose; kNone: not used
  std::size_t count = 0;
};

// Each pose joins the first group whose first pose is turned against it by less than step_rad, or begins one.
[[nodiscard]] PoseGroups group_by_orientation(std::span<const Eigen::Matrix3d> rotations,
                                              const std::vector<bool>& use, double step_rad);

// Adds up what the residuals of each group say together. Unknowns: 3 or more, the same in every call.
class GroupedScatter {
 public:
  GroupedScatter(const PoseGroups& groups, Eigen::Index unknowns)
      : groups_(groups), sums_(Eigen::MatrixXd::Zero(unknowns, static_cast<Eigen::Index>(groups.count))) {}
  // Of one pose that is used.
  void add(std::size_t pose, const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
           const Eigen::Ref<const Eigen::VectorXd>& residual) {
    sums_.col(static_cast<Eigen::Index>(groups_.group_of[pose])) += jacobian.transpose() * residual;
  }
  // information: N. equations: of a pose, r. Infinite where there are too few groups to tell.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::MatrixXd& information, double equations) const;

 private:
  const PoseGroups& groups_;
  Eigen::MatrixXd sums_;
};

}  // namespace arthronaut::tools
