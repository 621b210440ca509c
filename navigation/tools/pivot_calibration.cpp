#include "navigation/tools/pivot_calibration.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "navigation/tools/grouped_scatter.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::tools {
namespace {

using geometry::RigidTransform;

constexpr int kTriples = 600;
constexpr double kMinTripleSpreadRad = 8 * geometry::kPi / 180;
constexpr int kReweightings = 20;
constexpr double kTukey = 4.685;
// Markers are never better than this; below it a perfect synthetic motion would reject its own round-off.
constexpr double kMinScaleMm = 0.01;
// Within so much the errors of a marker's poses are taken to be alike.
constexpr double kAlikeRad = 6 * geometry::kPi / 180;
// Tukey's estimate is 95 % efficient: what the weights leave out is not lost.
constexpr double kEfficiency = 0.95;
// The radius that holds half of a 3D isotropic Gaussian, in units of its sigma per axis.
constexpr double kMedianRadius = 1.538;

struct Pose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

struct Fit {
  Eigen::Vector3d tip, pivot;
  Eigen::Matrix3d
      normal;  // sum of weights * (I - mean R^T mean R): the information about the tip, for unit sigma
  double weight = 0;
};

// Weighted least squares with the pivot eliminated: (I - M^T M) tip = M^T mean(t) - mean(R^T t), M = mean(R).
std::optional<Fit> fit_tip(const std::vector<Pose>& poses, const std::vector<double>& weights) {
  Eigen::Matrix3d mean_rotation = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_translation = Eigen::Vector3d::Zero(), mean_back = Eigen::Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double w = weights[i];
    if (w <= 0) continue;
    total += w;
    mean_rotation += w * poses[i].rotation;
    mean_translation += w * poses[i].translation;
    mean_back += w * poses[i].rotation.transpose() * poses[i].translation;
  }
  if (total <= 0) return std::nullopt;
  mean_rotation /= total;
  mean_translation /= total;
  mean_back /= total;
  const Eigen::Matrix3d system = Eigen::Matrix3d::Identity() - mean_rotation.transpose() * mean_rotation;
  if (!(std::abs(system.determinant()) > 1e-12)) return std::nullopt;
  Fit fit;
  fit.tip = system.inverse() * (mean_rotation.transpose() * mean_translation - mean_back);
  fit.pivot = mean_rotation * fit.tip + mean_translation;
  fit.normal = total * system;
  fit.weight = total;
  if (!fit.tip.allFinite()) return std::nullopt;
  return fit;
}

void residuals_of(const std::vector<Pose>& poses, const Fit& fit, std::vector<double>& residuals) {
  residuals.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    residuals[i] = (poses[i].rotation * fit.tip + poses[i].translation - fit.pivot).norm();
  }
}

double angle_between(const Pose& a, const Pose& b) {
  return geometry::rotation_angle_rad(Eigen::Quaterniond(a.rotation.transpose() * b.rotation));
}

// The triple of poses whose tip leaves the least median residual.
std::optional<Fit> least_median_fit(const std::vector<Pose>& poses, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, poses.size() - 1);
  std::optional<Fit> best;
  double best_median = 1e300;
  std::vector<double> residuals;
  for (int trial = 0; trial < kTriples; ++trial) {
    const std::vector<Pose> triple = {poses[pick(random)], poses[pick(random)], poses[pick(random)]};
    if (std::min({angle_between(triple[0], triple[1]), angle_between(triple[1], triple[2]),
                  angle_between(triple[2], triple[0])}) < kMinTripleSpreadRad) {
      continue;
    }
    const auto fit = fit_tip(triple, {1, 1, 1});
    if (!fit) continue;
    residuals_of(poses, *fit, residuals);
    const double middle = geometry::median(residuals);
    if (middle < best_median) {
      best_median = middle;
      best = fit;
    }
  }
  // A motion too narrow for the spread still deserves its (poor) answer, for the residual and the cone to be
  // told.
  return best ? best : fit_tip(poses, std::vector<double>(poses.size(), 1.0));
}

// Tukey's weights from the median residual, until the tip settles. Leaves the weights of the last fit.
std::optional<Fit> reweighted_fit(const std::vector<Pose>& poses, Fit fit, std::vector<double>& weights) {
  std::vector<double> residuals;
  for (int i = 0; i < kReweightings; ++i) {
    residuals_of(poses, fit, residuals);
    const double cut = kTukey * std::max(kMinScaleMm, geometry::median(residuals) / kMedianRadius);
    weights.resize(poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const double ratio = residuals[k] / cut;
      weights[k] = ratio < 1 ? std::pow(1 - ratio * ratio, 2) : 0;
    }
    const auto next = fit_tip(poses, weights);
    if (!next) return std::nullopt;
    const double moved = (next->tip - fit.tip).norm();
    fit = *next;
    if (moved < 1e-6) break;
  }
  return fit;
}

// The covariance of the tip: the usual one, or that of poses whose errors are alike where they are turned
// alike, whichever is the larger.
Eigen::Matrix3d tip_covariance(const std::vector<Pose>& poses, const std::vector<Eigen::Matrix3d>& rotations,
                               const Fit& fit, const PivotCalibrationSummary& summary, double variance) {
  const Eigen::Matrix3d information = fit.normal * (summary.inlier_count / fit.weight);
  const Eigen::Matrix3d usual = variance / kEfficiency * information.inverse();
  // The pivot is eliminated: the residual moves with the tip by R - M, M the mean rotation.
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (summary.is_inlier[i]) mean += rotations[i] / summary.inlier_count;
  const PoseGroups groups = group_by_orientation(rotations, summary.is_inlier, kAlikeRad);
  GroupedScatter scatter(groups, 3);
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (summary.is_inlier[i])
      scatter.add(i, rotations[i] - mean, rotations[i] * fit.tip + poses[i].translation - fit.pivot);
  const Eigen::Matrix3d grouped = scatter.covariance(information, 3) / kEfficiency;
  return grouped.trace() > usual.trace() ? grouped : usual;
}

// The shaft of each pose runs from the tip to the marker.
void measure_cone(const std::vector<Pose>& poses, const Fit& fit, const std::vector<double>& weights,
                  PivotCalibrationSummary& summary) {
  const Eigen::Vector3d shaft =
      fit.tip.norm() > 1e-9 ? Eigen::Vector3d(-fit.tip.normalized()) : Eigen::Vector3d::UnitZ();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (weights[i] > 0) mean += poses[i].rotation * shaft;
  }
  mean.normalize();
  const Eigen::Vector3d u = mean.unitOrthogonal(), v = mean.cross(u);
  std::vector<double> angles;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d direction = poses[i].rotation * shaft;
    const double angle_deg = geometry::deg_from_rad(geometry::angle_between_rad(mean, direction));
    const Eigen::Vector2d across(direction.dot(u), direction.dot(v));
    summary.tilt_deg.push_back(across.norm() > 1e-12 ? Eigen::Vector2d(angle_deg * across.normalized())
                                                     : Eigen::Vector2d::Zero());
    if (weights[i] > 0) angles.push_back(angle_deg);
  }
  std::sort(angles.begin(), angles.end());
  summary.cone_deg = angles[static_cast<std::size_t>(0.95 * static_cast<double>(angles.size() - 1) + 0.5)];
}

// The noise of the orientations shortens the tip along the shaft: l * 2 s^2 / (1 - m^2), with s the noise per
// axis in rad and m the mean of the shaft's cosine. Two thirds of the squared residual are across the shaft,
// by l * s.
double predicted_bias_mm(const PivotCalibrationSummary& summary) {
  const double length = summary.tip_in_tool_mm.norm();
  const double noise_rad = summary.rms_mm / std::sqrt(2.0) / std::max(length, 1.0);
  const double m = 0.5 * (1 + std::cos(geometry::rad_from_deg(summary.cone_deg)));
  return 2 * length * noise_rad * noise_rad / std::max(1 - m * m, 1e-9);
}

// One half alone may not tell a tip.
void measure_halves(const std::vector<Pose>& poses, const std::vector<double>& weights,
                    PivotCalibrationSummary& summary) {
  std::vector<double> first(weights), second(weights);
  const std::size_t middle = weights.size() / 2;
  for (std::size_t i = 0; i < weights.size(); ++i) (i < middle ? second : first)[i] = 0;
  const auto a = fit_tip(poses, first), b = fit_tip(poses, second);
  if (!a || !b) return;
  summary.tip_change_mm = b->tip - a->tip;
  summary.half_change_mm = std::max(summary.tip_change_mm.norm(), (a->pivot - b->pivot).norm());
}

void judge(const PivotCalibrationOptions& options, PivotCalibrationSummary& summary) {
  using Outcome = PivotCalibrationSummary::Outcome;
  summary.outcome = Outcome::Ok;
  const auto refuse = [&](Outcome outcome, const std::string& reason) {
    if (summary.outcome == Outcome::Ok) summary.outcome = outcome;
    summary.reasons.push_back(reason);
  };
  if (summary.inlier_count < options.min_inlier_share * summary.pose_count) {
    refuse(Outcome::TooManyOutliers,
           files::format("only %d of %d poses agree on one tip", summary.inlier_count, summary.pose_count));
  }
  if (summary.cone_deg < options.min_cone_deg) {
    refuse(Outcome::ConeTooNarrow,
           files::format("the tool was swung through a cone of %.1f deg to each side; %.0f deg are needed",
                         summary.cone_deg, options.min_cone_deg));
  }
  if (summary.distinct_count < options.min_distinct_poses) {
    refuse(Outcome::TipUncertain, files::format("only %d distinct orientations; %d are needed",
                                                summary.distinct_count, options.min_distinct_poses));
  }
  if (summary.rms_mm > options.max_rms_mm) {
    refuse(Outcome::ResidualTooLarge,
           files::format("the tip did not stay in place: %.2f mm left over, at most %.2f mm allowed",
                         summary.rms_mm, options.max_rms_mm));
  }
  if (summary.sigma_mm > options.max_sigma_mm) {
    refuse(Outcome::TipUncertain, files::format("the tip is uncertain by %.2f mm, at most %.2f mm allowed",
                                                summary.sigma_mm, options.max_sigma_mm));
  }
  if (summary.bias_mm > options.max_bias_mm) {
    refuse(Outcome::TipUncertain,
           files::format("noise shortens the tip by about %.2f mm, at most %.2f mm allowed", summary.bias_mm,
                         options.max_bias_mm));
  }
  if (summary.half_change_mm < 0) {
    refuse(Outcome::TipUncertain,
           "one half of the motion alone does not tell where the tip is: tilt to all sides twice");
  } else if (summary.half_change_mm > options.max_half_change_mm) {
    refuse(Outcome::TipUncertain,
           files::format("the two halves of the motion differ by %.2f mm, at most %.2f mm allowed",
                         summary.half_change_mm, options.max_half_change_mm));
  }
  summary.message = summary.is_usable() ? "The tip is known." : summary.reasons.front();
}

void check(const PivotCalibrationOptions& options) {
  const auto require_positive = [](double value, const char* name) {
    if (!(value > 0)) throw InvalidInput(std::string("pivot calibration: ") + name + " must be above 0");
  };
  require_positive(options.min_step_deg, "min_step_deg");
  require_positive(options.min_distinct_poses, "min_distinct_poses");
  require_positive(options.min_cone_deg, "min_cone_deg");
  require_positive(options.max_rms_mm, "max_rms_mm");
  require_positive(options.max_sigma_mm, "max_sigma_mm");
  require_positive(options.max_bias_mm, "max_bias_mm");
  require_positive(options.max_half_change_mm, "max_half_change_mm");
  require_positive(options.min_inlier_share, "min_inlier_share");
  if (options.min_inlier_share > 1)
    throw InvalidInput("pivot calibration: min_inlier_share must be at most 1");
}

}  // namespace

Eigen::Matrix3d PivotCalibrationSummary::tip_error_mm2() const {
  const double length_mm = tip_in_tool_mm.norm();
  if (!has_tip() || length_mm < 1e-6) return tip_covariance_mm2;
  const Eigen::Vector3d bias = bias_mm * (tip_in_tool_mm / length_mm);
  // By chance alone the square of the halves' difference is four times the covariance: each half has twice
  // that of the whole. What is more is a tip that moved, and the whole is off by up to half of it.
  const double change_mm2 = tip_change_mm.squaredNorm(), by_chance_mm2 = 4 * tip_covariance_mm2.trace();
  Eigen::Matrix3d moved = Eigen::Matrix3d::Zero();
  if (change_mm2 > by_chance_mm2)
    moved = (1 - by_chance_mm2 / change_mm2) / 4 * tip_change_mm * tip_change_mm.transpose();
  return tip_covariance_mm2 + bias * bias.transpose() + moved;
}

PivotCalibrationSummary calibrate_pivot(std::span<const RigidTransform> fixed_from_tool,
                                        const PivotCalibrationOptions& options) {
  using Outcome = PivotCalibrationSummary::Outcome;
  check(options);
  PivotCalibrationSummary summary;
  summary.pose_count = static_cast<int>(fixed_from_tool.size());
  if (fixed_from_tool.size() < 3) {
    summary.outcome = Outcome::TooFewPoses;
    summary.message = "fewer than three poses";
    summary.reasons = {summary.message};
    return summary;
  }
  std::vector<Pose> poses;
  poses.reserve(fixed_from_tool.size());
  for (const RigidTransform& pose : fixed_from_tool) poses.push_back({pose.matrix(), pose.translation_mm});

  std::vector<double> weights;
  const auto start = least_median_fit(poses, options.seed);
  const auto fit = start ? reweighted_fit(poses, *start, weights) : std::nullopt;
  if (!fit) {
    summary.outcome = Outcome::NoPivot;
    summary.message = "the tool was not turned: every tip fits";
    summary.reasons = {summary.message};
    return summary;
  }
  std::vector<double> residuals;
  residuals_of(poses, *fit, residuals);
  double squares = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    summary.is_inlier.push_back(weights[i] > 0);
    summary.inlier_count += weights[i] > 0;
    if (weights[i] > 0) squares += residuals[i] * residuals[i];
  }
  summary.tip_in_tool_mm = fit->tip;
  summary.pivot_in_fixed_mm = fit->pivot;
  summary.rms_mm = std::sqrt(squares / summary.inlier_count);
  // Six unknowns out of three equations a pose.
  const double variance = squares / std::max(1, 3 * summary.inlier_count - 6);
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(poses.size());
  for (const Pose& pose : poses) rotations.push_back(pose.rotation);
  summary.tip_covariance_mm2 = tip_covariance(poses, rotations, *fit, summary, variance);
  summary.sigma_mm = std::sqrt(std::max(
      0.0,
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(summary.tip_covariance_mm2).eigenvalues().maxCoeff()));
  measure_cone(poses, *fit, weights, summary);
  summary.distinct_count = static_cast<int>(
      group_by_orientation(rotations, summary.is_inlier, geometry::rad_from_deg(options.min_step_deg)).count);
  summary.bias_mm = predicted_bias_mm(summary);
  measure_halves(poses, weights, summary);
  judge(options, summary);
  return summary;
}

}  // namespace arthronaut::tools
