#include "navigation/calibration/adjustment.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

constexpr double kMarkSigmaRad = 0.15 * geometry::kPi / 180;  // of a mark angle measured in one picture
constexpr double kCircleSigmaPx = 0.3;                        // of a circle's centre
constexpr double kHuber = 3.0;                                // in sigmas

// Division model of the header of camera_model.h in the calibration's own medium (n = 1).
// lens: focal, xi, principal x, y, rotation centre x, y.
template <typename T>
void turn(const T* center, const T* point, const T& angle, T* turned) {
  const T c = cos(angle), s = sin(angle), x = point[0] - center[0], y = point[1] - center[1];
  turned[0] = center[0] + c * x - s * y;
  turned[1] = center[1] + s * x + c * y;
}

struct CornerError {
  Eigen::Vector2d pixel, board_mm;
  double sigma_px;
  template <typename T>
  bool operator()(const T* lens, const T* angle, const T* pose, T* error) const {
    const T on_board[3] = {T(board_mm.x()), T(board_mm.y()), T(0)};
    T p[3], principal[2];
    ceres::AngleAxisRotatePoint(pose, on_board, p);
    for (int k = 0; k < 3; ++k) p[k] += pose[3 + k];
    const T under_root = p[2] * p[2] - 4.0 * lens[1] * (p[0] * p[0] + p[1] * p[1]);
    if (!(under_root > T(0)) || !(p[2] > T(0))) return false;
    const T scale = 2.0 * lens[0] / (p[2] + sqrt(under_root));
    turn(lens + 4, lens + 2, angle[0], principal);
    error[0] = (T(pixel.x()) - principal[0] - scale * p[0]) / sigma_px;
    error[1] = (T(pixel.y()) - principal[1] - scale * p[1]) / sigma_px;
    return true;
  }
};

struct MarkError {
  double angle_rad;
  template <typename T>
  bool operator()(const T* angle, T* error) const {
    error[0] = (angle[0] - T(angle_rad)) / kMarkSigmaRad;
    return true;
  }
};

struct CircleError {
  Eigen::Vector2d center_px;
  template <typename T>
  bool operator()(const T* lens, const T* angle, const T* circle, T* error) const {
    T turned[2];
    turn(lens + 4, circle, angle[0], turned);
    error[0] = (T(center_px.x()) - turned[0]) / kCircleSigmaPx;
    error[1] = (T(center_px.y()) - turned[1]) / kCircleSigmaPx;
    return true;
  }
};

// The estimate as the solver's blocks.
struct Blocks {
  double lens[6], circle[2];
  std::vector<double> angles;
  std::vector<std::array<double, 6>> poses;

  explicit Blocks(const Estimate& e)
      : lens{e.focal_px,
             e.xi,
             e.principal_point_px.x(),
             e.principal_point_px.y(),
             e.rotation_center_px.x(),
             e.rotation_center_px.y()},
        circle{e.circle_center_px.x(), e.circle_center_px.y()},
        angles(e.lens_angle_rad) {
    for (const auto& pose : e.camera_from_board) {
      std::array<double, 6> block;
      const double q[4] = {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()};
      ceres::QuaternionToAngleAxis(q, block.data());
      for (int k = 0; k < 3; ++k) block[static_cast<std::size_t>(3 + k)] = pose.translation_mm[k];
      poses.push_back(block);
    }
  }
  void store(Estimate& e) const {
    e.focal_px = lens[0];
    e.xi = lens[1];
    e.principal_point_px = {lens[2], lens[3]};
    e.rotation_center_px = {lens[4], lens[5]};
    e.circle_center_px = {circle[0], circle[1]};
    e.lens_angle_rad = angles;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      double q[4];
      ceres::AngleAxisToQuaternion(poses[i].data(), q);
      e.camera_from_board[i].rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
      e.camera_from_board[i].translation_mm = Eigen::Map<const Eigen::Vector3d>(poses[i].data() + 3);
    }
  }
};

void set_constant(ceres::Problem& problem, Blocks& blocks, const AdjustmentOptions& options) {
  if (options.fix_intrinsics) {
    problem.SetParameterBlockConstant(blocks.lens);
    if (problem.HasParameterBlock(blocks.circle)) problem.SetParameterBlockConstant(blocks.circle);
  } else if (!options.turns) {
    problem.SetManifold(blocks.lens, new ceres::SubsetManifold(6, {4, 5}));
  }
  if (!options.turns)
    for (double& angle : blocks.angles) problem.SetParameterBlockConstant(&angle);
}

void compute_covariance(ceres::Problem& problem, const Blocks& blocks, AdjustmentResult& result) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.null_space_rank = 0;  // a direction that the pictures leave open is a failure, not exact
  ceres::Covariance covariance(options);
  std::vector<std::pair<const double*, const double*>> wanted = {{blocks.lens, blocks.lens}};
  for (const double& angle : blocks.angles) wanted.emplace_back(&angle, &angle);
  if (!covariance.Compute(wanted, &problem)) return;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> block;
  if (!covariance.GetCovarianceBlock(blocks.lens, blocks.lens, block.data())) return;
  result.covariance = block;
  for (const double& angle : blocks.angles) {
    double variance = 0;
    covariance.GetCovarianceBlock(&angle, &angle, &variance);
    result.lens_angle_sigma_rad.push_back(std::sqrt(std::max(0.0, variance)));
  }
}

// The scale of the corners' errors against their sigmas: from the median length, which outliers do not move.
// The length of a two-dimensional normal error has its median at 1.177 sigma.
double scale_of(std::span<const Sighting> sightings,
                const std::vector<std::vector<Eigen::Vector2d>>& residuals_px) {
  std::vector<double> in_sigmas;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    for (std::size_t k = 0; k < residuals_px[i].size(); ++k)
      in_sigmas.push_back(residuals_px[i][k].norm() / sightings[i].sigma_px[k]);
  return std::max(0.05, geometry::median_in_place(std::span(in_sigmas)) / 1.177);
}

AdjustmentResult adjust_at_scale(std::span<const Sighting> sightings, const Estimate& start,
                                 const AdjustmentOptions& options, double scale) {
  AdjustmentResult result;
  result.estimate = start;
  Blocks blocks(start);
  ceres::Problem problem;
  std::size_t corner_count = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& seen = sightings[i];
    for (std::size_t k = 0; k < seen.pixels.size(); ++k)
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerError, 2, 6, 1, 6>(new CornerError{
                                   seen.pixels[k], seen.board_mm[k], scale * seen.sigma_px[k]}),
                               new ceres::HuberLoss(kHuber), blocks.lens, &blocks.angles[i],
                               blocks.poses[i].data());
    corner_count += seen.pixels.size();
    if (seen.has_angle) {
      const double measured =
          geometry::rad_from_deg(std::remainder(seen.mark_angle_deg - start.reference_mark_angle_deg, 360.0));
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MarkError, 1, 1>(new MarkError{measured}),
                               nullptr, &blocks.angles[i]);
    }
    if (seen.has_circle && options.turns)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<CircleError, 2, 6, 1, 2>(new CircleError{seen.circle_center_px}),
          nullptr, blocks.lens, &blocks.angles[i], blocks.circle);
  }
  set_constant(problem, blocks, options);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  auto* order = new ceres::ParameterBlockOrdering;
  for (auto& pose : blocks.poses) order->AddElementToGroup(pose.data(), 0);
  for (double& angle : blocks.angles) order->AddElementToGroup(&angle, 1);
  order->AddElementToGroup(blocks.lens, 1);
  if (problem.HasParameterBlock(blocks.circle)) order->AddElementToGroup(blocks.circle, 1);
  solver.linear_solver_ordering.reset(order);
  solver.max_num_iterations = 100;
  solver.function_tolerance = 1e-10;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;  // the same sum in the same order, whatever the machine
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return result;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.corner_scale = scale;
  result.cost = summary.final_cost;
  blocks.store(result.estimate);

  double sum = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    std::vector<Eigen::Vector2d>& residuals = result.residuals_px.emplace_back();
    for (std::size_t k = 0; k < sightings[i].pixels.size(); ++k) {
      Eigen::Vector2d error(1e3, 1e3);
      CornerError{sightings[i].pixels[k], sightings[i].board_mm[k], 1.0}(
          blocks.lens, &blocks.angles[i], blocks.poses[i].data(), error.data());
      residuals.push_back(error);
      sum += residuals.back().squaredNorm();
    }
  }
  result.rms_px = std::sqrt(sum / static_cast<double>(corner_count));
  if (options.with_covariance) compute_covariance(problem, blocks, result);
  return result;
}

}  // namespace

AdjustmentResult adjust(std::span<const Sighting> sightings, const Estimate& start,
                        const AdjustmentOptions& options) {
  if (options.corner_scale > 0) return adjust_at_scale(sightings, start, options, options.corner_scale);
  AdjustmentOptions without = options;
  without.with_covariance = false;
  const AdjustmentResult first = adjust_at_scale(sightings, start, without, 1.0);
  if (first.rms_px < 0) return first;
  // Once more with the corners' true noise: it sets what counts as an outlier, the weight of corners against
  // mark and circle, and the covariance.
  return adjust_at_scale(sightings, first.estimate, options, scale_of(sightings, first.residuals_px));
}

}  // namespace arthronaut::calibration
