#include "navigation/tools/spin_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "navigation/tools/grouped_scatter.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::tools {
namespace {

using geometry::RigidTransform;

struct Axis {
  Eigen::Vector3d in_tool, in_fixed;  // unit directions
  Eigen::Vector3d point_in_tool, point_in_fixed;
};

Axis fit_axis(std::span<const RigidTransform> poses, const std::vector<bool>& use,
              const Eigen::Vector3d& towards) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (use[i]) mean += poses[i].matrix();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(mean, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Axis axis;
  axis.in_tool = svd.matrixV().col(0);
  axis.in_fixed = svd.matrixU().col(0);
  if (axis.in_tool.dot(towards) < 0) {
    axis.in_tool = -axis.in_tool;
    axis.in_fixed = -axis.in_fixed;
  }
  // P (R p + t - c) = 0 with P across the fixed axis. p along the tool's axis and c along the fixed one are
  // free: a weak pull to zero takes the feet of the two origins.
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.in_fixed * axis.in_fixed.transpose();
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!use[i]) continue;
    Eigen::Matrix<double, 3, 6> row;
    row << across * poses[i].matrix(), -across;
    normal += row.transpose() * row;
    right -= row.transpose() * poses[i].translation_mm;
  }
  normal.topLeftCorner<3, 3>() += 1e3 * axis.in_tool * axis.in_tool.transpose();
  normal.bottomRightCorner<3, 3>() += 1e3 * axis.in_fixed * axis.in_fixed.transpose();
  const Eigen::Matrix<double, 6, 1> solution = normal.ldlt().solve(right);
  axis.point_in_tool = solution.head<3>();
  axis.point_in_fixed = solution.tail<3>();
  return axis;
}

double wobble_rad(const Axis& axis, const RigidTransform& pose) {
  return geometry::angle_between_rad(pose.rotate(axis.in_tool), axis.in_fixed);
}

double offset_mm(const Axis& axis, const RigidTransform& pose) {
  const Eigen::Vector3d apart = pose * axis.point_in_tool - axis.point_in_fixed;
  return (apart - axis.in_fixed * axis.in_fixed.dot(apart)).norm();
}

// The sector that the spin covers: the full circle less the widest gap.
double turn_deg(const Axis& axis, std::span<const RigidTransform> poses, const std::vector<bool>& use) {
  const Eigen::Vector3d spoke = axis.in_tool.unitOrthogonal();
  const Eigen::Vector3d u = axis.in_fixed.unitOrthogonal(), v = axis.in_fixed.cross(u);
  std::vector<double> angles;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!use[i]) continue;
    const Eigen::Vector3d turned = poses[i].rotate(spoke);
    angles.push_back(geometry::deg_from_rad(std::atan2(turned.dot(v), turned.dot(u))));
  }
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 360 - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  return 360 - widest;
}

// One sigma of each coordinate across the axis, of its direction (rad) and of its point, from poses whose
// errors are alike where they are turned alike.
struct Scatter {
  double direction_rad, point_mm;
};

Scatter scatter_of(const Axis& axis, std::span<const RigidTransform> poses,
                   std::span<const Eigen::Matrix3d> rotations, const std::vector<bool>& use,
                   const PoseGroups& groups) {
  const auto across = [](const Eigen::Vector3d& direction) {
    Eigen::Matrix<double, 3, 2> plane;
    plane.col(0) = direction.unitOrthogonal();
    plane.col(1) = direction.cross(plane.col(0));
    return plane;
  };
  const Eigen::Matrix<double, 3, 2> tool = across(axis.in_tool), fixed = across(axis.in_fixed);
  // Direction and point are seen alike: R a = c and R p + t = c, across the fixed axis.
  GroupedScatter directions(groups, 4), points(groups, 4);
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!use[i]) continue;
    Eigen::Matrix<double, 2, 4> jacobian;
    jacobian << fixed.transpose() * rotations[i] * tool, -Eigen::Matrix2d::Identity();
    information += jacobian.transpose() * jacobian;
    directions.add(i, jacobian, fixed.transpose() * (rotations[i] * axis.in_tool - axis.in_fixed));
    points.add(i, jacobian, fixed.transpose() * (poses[i] * axis.point_in_tool - axis.point_in_fixed));
  }
  const auto sigma = [&](const GroupedScatter& scatter) {
    return std::sqrt(scatter.covariance(information, 2).topLeftCorner<2, 2>().trace() / 2);
  };
  return {sigma(directions), sigma(points)};
}

void refuse(SpinCalibrationSummary& summary, SpinCalibrationSummary::Outcome outcome, std::string reason) {
  if (summary.is_usable()) summary.outcome = outcome;
  summary.reasons.push_back(std::move(reason));
}

}  // namespace

SpinCalibrationSummary calibrate_spin(std::span<const RigidTransform> fixed_from_tool,
                                      const SpinCalibrationOptions& options) {
  using Outcome = SpinCalibrationSummary::Outcome;
  if (options.min_poses < 3 || !(options.min_turn_deg > 0) || !(options.max_rms_mm > 0) ||
      !(options.max_direction_sigma_deg > 0) || !(options.outlier_factor > 0) ||
      !(options.min_step_deg > 0) || options.min_distinct_places < 3 || !(options.min_inlier_share > 0) ||
      options.min_inlier_share > 1) {
    throw InvalidInput(
        "spin calibration: every limit must be above 0, min_poses and min_distinct_places at least 3, and a "
        "share at most 1");
  }
  SpinCalibrationSummary summary;
  summary.pose_count = static_cast<int>(fixed_from_tool.size());
  summary.outcome = Outcome::Ok;
  if (summary.pose_count < options.min_poses) {
    refuse(summary, Outcome::TooFewPoses,
           files::format("only %d poses; %d are needed", summary.pose_count, options.min_poses));
    summary.message = summary.reasons.front();
    return summary;
  }

  // A few rounds of leaving out what stands apart, in angle or in place.
  std::vector<bool> use(fixed_from_tool.size(), true);
  const Eigen::Vector3d towards = options.declared_direction.value_or(-Eigen::Vector3d::UnitY()).normalized();
  Axis axis = fit_axis(fixed_from_tool, use, towards);
  for (int round = 0; round < 6; ++round) {
    std::vector<double> angles, offsets;
    for (const RigidTransform& pose : fixed_from_tool) {
      angles.push_back(wobble_rad(axis, pose));
      offsets.push_back(offset_mm(axis, pose));
    }
    const double angle_limit = options.outlier_factor * std::max(1e-4, geometry::median(angles));
    const double offset_limit = options.outlier_factor * std::max(1e-3, geometry::median(offsets));
    for (std::size_t i = 0; i < use.size(); ++i)
      use[i] = angles[i] <= angle_limit && offsets[i] <= offset_limit;
    axis = fit_axis(fixed_from_tool, use, towards);
  }

  double squares = 0, wobble = 0;
  for (std::size_t i = 0; i < use.size(); ++i) {
    if (!use[i]) continue;
    ++summary.inlier_count;
    squares += std::pow(offset_mm(axis, fixed_from_tool[i]), 2);
    wobble += std::pow(wobble_rad(axis, fixed_from_tool[i]), 2);
  }
  const int n = std::max(1, summary.inlier_count);
  summary.axis_direction_in_tool = axis.in_tool;
  summary.axis_point_in_tool_mm = axis.point_in_tool;
  summary.rms_mm = std::sqrt(squares / n);
  summary.wobble_deg = geometry::deg_from_rad(std::sqrt(wobble / n));
  summary.turn_deg = turn_deg(axis, fixed_from_tool, use);
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(fixed_from_tool.size());
  for (const RigidTransform& pose : fixed_from_tool) rotations.push_back(pose.matrix());
  const PoseGroups places =
      group_by_orientation(rotations, use, geometry::rad_from_deg(options.min_step_deg));
  summary.place_count = static_cast<int>(places.count);
  const Scatter scatter = scatter_of(axis, fixed_from_tool, rotations, use, places);
  // The wobble is the noise of two axes; the part of it that turns with the tool is averaged over the sector.
  const double usual_deg = 1.3 * summary.wobble_deg / std::sqrt(static_cast<double>(n));
  summary.direction_sigma_deg =
      std::hypot(std::max(usual_deg, geometry::deg_from_rad(scatter.direction_rad)), kSystematic_deg);
  // With m the mean of e^(i angle) over the sector, only 1 - m^2 of each pose tells the tool's own offset
  // from the sleeve's; a full turn tells all.
  const double half_rad = std::max(geometry::rad_from_deg(summary.turn_deg) / 2, 1e-3);
  const double mean = std::sin(half_rad) / half_rad;
  const double usual_mm = summary.rms_mm / std::sqrt(2.0 * n * (1 - mean * mean));
  summary.point_sigma_mm = std::hypot(std::max(usual_mm, scatter.point_mm), kSystematic_mm);

  if (summary.inlier_count < options.min_inlier_share * summary.pose_count) {
    refuse(summary, Outcome::TooManyOutliers,
           files::format("only %d of %d poses agree on one axis", summary.inlier_count, summary.pose_count));
  }
  if (summary.turn_deg < options.min_turn_deg) {
    refuse(summary, Outcome::TurnTooSmall,
           files::format("the guide was turned by %.0f deg; %.0f deg are needed", summary.turn_deg,
                         options.min_turn_deg));
  }
  if (summary.place_count < options.min_distinct_places) {
    refuse(summary, Outcome::TooFewPlaces,
           files::format("the guide rested in %d places of its turn; %d are needed, %.0f deg apart or more",
                         summary.place_count, options.min_distinct_places, options.min_step_deg));
  }
  if (summary.rms_mm > options.max_rms_mm) {
    refuse(summary, Outcome::ResidualTooLarge,
           files::format("the axis did not stay in place: %.2f mm left over, at most %.2f mm allowed",
                         summary.rms_mm, options.max_rms_mm));
  }
  if (summary.direction_sigma_deg > options.max_direction_sigma_deg) {
    refuse(summary, Outcome::AxisUncertain,
           files::format("the axis is uncertain by %.2f deg, at most %.2f deg allowed",
                         summary.direction_sigma_deg, options.max_direction_sigma_deg));
  }
  const double slope_deg = geometry::deg_from_rad(std::asin(std::min(1.0, axis.in_tool.dot(towards))));
  if (slope_deg < options.least_slope_deg) {
    refuse(summary, Outcome::DirectionUnknown,
           options.declared_direction
               ? files::format("the axis lies %.0f deg off the declared direction: another tool or marker?",
                               90 - slope_deg)
               : "which way along the axis is drilled cannot be told: declare axis_direction in tools.json");
  }
  summary.message = summary.is_usable() ? "The axis is known." : summary.reasons.front();
  return summary;
}

}  // namespace arthronaut::tools
