#include "navigation/tools/rig_problem.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "planning/geometry/quantile.h"

namespace arthronaut::tools {

namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;
using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix86d = Eigen::Matrix<double, 8, 6>;
// Rotation vector, then translation.
using Parameters = std::array<double, 6>;

constexpr double kOutlier = 4.5;          // of the root mean square of a view's corners, in robust sigmas
constexpr double kLeastSigma_px = 0.005;  // sightings without noise are judged as if they had so much
constexpr double kCluster_s = 0.5;        // errors are alike for so long
// Corners count for each coordinate; how near two relative poses agree is said at this arm's length.
constexpr double kArm_mm = 6;

Parameters parameters_of(const RigidTransform& pose) {
  const Eigen::AngleAxisd turn(pose.rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  const Eigen::Vector3d& t = pose.translation_mm;
  return {vector.x(), vector.y(), vector.z(), t.x(), t.y(), t.z()};
}

RigidTransform pose_of(const Parameters& p) {
  const Eigen::Vector3d vector(p[0], p[1], p[2]);
  const double angle = vector.norm();
  RigidTransform pose;
  if (angle > 0) pose.rotation = Eigen::AngleAxisd(angle, vector / angle);
  pose.translation_mm = {p[3], p[4], p[5]};
  return pose;
}

template <typename T>
void place(const T* pose, const T* point, T* placed) {
  ceres::AngleAxisRotatePoint(pose, point, placed);
  for (int i = 0; i < 3; ++i) placed[i] += pose[3 + i];
}

// Corners of one view, px / sigma.
struct CornerDistances {
  const RigView& view;
  std::array<Eigen::Vector3d, 4> corners_mm;
  double sigma_px;

  template <typename T>
  bool operator()(const T* frame, const T* marker, T* residuals) const {
    for (std::size_t k = 0; k < 4; ++k) {
      const T corner[3] = {T(corners_mm[k].x()), T(corners_mm[k].y()), T(corners_mm[k].z())};
      T in_body[3], in_camera[3];
      place(marker, corner, in_body);
      place(frame, in_body, in_camera);
      if (!(in_camera[2] > T(0))) return false;
      residuals[2 * k] = (kRigFocal_px * in_camera[0] / in_camera[2] - view.corners_px[k].x()) / sigma_px;
      residuals[2 * k + 1] = (kRigFocal_px * in_camera[1] / in_camera[2] - view.corners_px[k].y()) / sigma_px;
    }
    return true;
  }
};

double apart_mm(const RigidTransform& a, const RigidTransform& b) {
  const Vector6d between = geometry::log(a.inverse() * b);
  return std::hypot(between.head<3>().norm(), kArm_mm * between.tail<3>().norm());
}

// The one among them that most others are near to.
RigidTransform most_agreed(const std::vector<RigidTransform>& poses) {
  constexpr double kFar_mm = 2;
  constexpr std::size_t kMost = 60,
                        kPrime = 7919;  // so that what is wrong at every tenth is not all that is asked
  const std::size_t count = std::min(kMost, poses.size());
  const auto asked = [&](std::size_t i) -> const RigidTransform& {
    return poses.size() <= kMost ? poses[i] : poses[(i * kPrime) % poses.size()];
  };
  double least = 1e300;
  RigidTransform best;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += std::min(kFar_mm, apart_mm(asked(i), asked(k)));
    if (sum >= least) continue;
    least = sum;
    best = asked(i);
  }
  return best;
}

// By frame, the views in it: [first, end).
std::vector<std::pair<std::size_t, std::size_t>> ranges_of(const RigProblem& problem) {
  std::vector<std::pair<std::size_t, std::size_t>> ranges(problem.frame_count());
  for (std::size_t first = 0; first < problem.views.size();) {
    std::size_t end = first;
    while (end < problem.views.size() && problem.views[end].frame == problem.views[first].frame) ++end;
    ranges[problem.views[first].frame] = {first, end};
    first = end;
  }
  return ranges;
}

// Places one after the other, each beside one that is placed already; nullopt when some are never reached.
std::optional<std::vector<RigidTransform>> first_places(const RigProblem& problem) {
  const std::size_t count = problem.marker_count();
  std::vector<std::vector<std::vector<RigidTransform>>> from_to(
      count, std::vector<std::vector<RigidTransform>>(count));
  for (const auto& [first, end] : ranges_of(problem)) {
    for (std::size_t a = first; a < end; ++a)
      for (std::size_t b = first; b < end; ++b)
        if (a != b)
          from_to[problem.views[a].marker][problem.views[b].marker].push_back(
              problem.views[a].camera_from_marker.inverse() * problem.views[b].camera_from_marker);
  }
  std::vector<RigidTransform> places(count);
  std::vector<char> is_placed(count, 0);
  is_placed[0] = 1;
  for (std::size_t placed = 1; placed < count; ++placed) {
    std::size_t from = 0, to = 0, most = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b)
        if (is_placed[a] && !is_placed[b] && from_to[a][b].size() > most) {
          most = from_to[a][b].size();
          from = a;
          to = b;
        }
    if (most == 0) return std::nullopt;
    places[to] = places[from] * most_agreed(from_to[from][to]);
    is_placed[to] = 1;
  }
  return places;
}

std::optional<Vector8d> residual_of(const RigProblem& problem, const RigView& view,
                                    const RigidTransform& camera_from_body, const RigidTransform& place_of) {
  Vector8d residual;
  const auto corners_mm = rig_corners_mm(problem.size_mm[view.marker]);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto pixel = rig_project(camera_from_body * (place_of * corners_mm[k]));
    if (!pixel) return std::nullopt;
    residual.segment<2>(static_cast<Eigen::Index>(2 * k)) = *pixel - view.corners_px[k];
  }
  return residual;
}

double rms_px(const RigProblem& problem, const RigSolution& solution, const RigView& view) {
  const auto residual = residual_of(problem, view, solution.camera_from_body[view.frame],
                                    solution.reference_from_marker[view.marker]);
  return residual ? residual->norm() / std::sqrt(8.0) : 1e9;
}

// Each frame from the one of its markers that the others contradict least.
void first_frames(const RigProblem& problem, RigSolution& solution) {
  solution.camera_from_body.resize(problem.frame_count());
  const auto ranges = ranges_of(problem);
  for (std::size_t frame = 0; frame < ranges.size(); ++frame) {
    double least = 1e300;
    RigidTransform best;
    for (std::size_t a = ranges[frame].first; a < ranges[frame].second; ++a) {
      const RigView& from = problem.views[a];
      solution.camera_from_body[frame] =
          from.camera_from_marker * solution.reference_from_marker[from.marker].inverse();
      double sum = 0;
      for (std::size_t b = ranges[frame].first; b < ranges[frame].second; ++b)
        sum += std::min(30.0, rms_px(problem, solution, problem.views[b]));
      if (sum >= least) continue;
      least = sum;
      best = solution.camera_from_body[frame];
    }
    solution.camera_from_body[frame] = best;
  }
}

// Most frames see two markers, which cannot both be far off by themselves: what is left of 8 residuals a view
// when a pose is free for each frame.
double robust_sigma_px(const RigProblem& problem, const RigSolution& solution) {
  std::vector<double> rms;
  for (const RigView& view : problem.views) rms.push_back(rms_px(problem, solution, view));
  const double freedom = 1 - 6.0 * static_cast<double>(problem.frame_count()) /
                                 (8.0 * static_cast<double>(problem.views.size()));
  return std::max(kLeastSigma_px, geometry::median(std::move(rms)) / std::sqrt(std::max(0.2, freedom)));
}

bool optimise(const RigProblem& problem, double sigma_px, double loss_sigma, int iterations,
              RigSolution& solution) {
  std::vector<Parameters> frames, markers;
  for (const RigidTransform& pose : solution.camera_from_body) frames.push_back(parameters_of(pose));
  for (const RigidTransform& pose : solution.reference_from_marker) markers.push_back(parameters_of(pose));
  ceres::Problem least_squares;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (const RigView& view : problem.views) {
    auto* cost = new ceres::AutoDiffCostFunction<CornerDistances, 8, 6, 6>(
        new CornerDistances{view, rig_corners_mm(problem.size_mm[view.marker]), sigma_px});
    least_squares.AddResidualBlock(cost, new ceres::CauchyLoss(loss_sigma), frames[view.frame].data(),
                                   markers[view.marker].data());
    ordering->AddElementToGroup(frames[view.frame].data(), 0);
    ordering->AddElementToGroup(markers[view.marker].data(), 1);
  }
  least_squares.SetParameterBlockConstant(markers.front().data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering.reset(ordering);
  options.max_num_iterations = iterations;
  options.function_tolerance = 1e-9;
  options.parameter_tolerance = 1e-9;
  options.num_threads = 1;  // the same to the last bit from run to run
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);
  if (!summary.IsSolutionUsable()) return false;
  for (std::size_t i = 0; i < frames.size(); ++i) solution.camera_from_body[i] = pose_of(frames[i]);
  for (std::size_t i = 1; i < markers.size(); ++i) solution.reference_from_marker[i] = pose_of(markers[i]);
  return true;
}

}  // namespace

std::array<Eigen::Vector3d, 4> rig_corners_mm(double size_mm) {
  const double h = size_mm / 2;
  return {Eigen::Vector3d(-h, h, 0), Eigen::Vector3d(h, h, 0), Eigen::Vector3d(h, -h, 0),
          Eigen::Vector3d(-h, -h, 0)};
}

std::optional<Eigen::Vector2d> rig_project(const Eigen::Vector3d& in_camera_mm) {
  if (!(in_camera_mm.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(kRigFocal_px / in_camera_mm.z() * in_camera_mm.head<2>());
}

std::optional<RigSolution> solve_rig(const RigProblem& problem) {
  const auto places = first_places(problem);
  if (!places || problem.views.empty()) return std::nullopt;
  RigSolution solution;
  solution.reference_from_marker = *places;
  first_frames(problem, solution);
  // Coarse first, then by the noise that is there.
  for (int round = 0; round < 3; ++round) {
    solution.sigma_px = robust_sigma_px(problem, solution);
    if (!optimise(problem, solution.sigma_px, round == 0 ? 6 : 4, round == 0 ? 30 : 60, solution))
      return std::nullopt;
  }
  solution.sigma_px = robust_sigma_px(problem, solution);
  for (const RigView& view : problem.views)
    solution.is_inlier.push_back(rms_px(problem, solution, view) < kOutlier * solution.sigma_px ? 1 : 0);
  return solution;
}

Eigen::MatrixXd rig_covariance(const RigProblem& problem, const RigSolution& solution) {
  const auto size = static_cast<Eigen::Index>(6 * (problem.marker_count() - 1));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size), spread = information;
  Eigen::VectorXd cluster = Eigen::VectorXd::Zero(size);
  double cluster_begin_s = -1e300, squares = 0;
  long cluster_count = 0, freedom = -size;
  const auto end_cluster = [&] {
    if (cluster_begin_s > -1e300) {
      spread += cluster * cluster.transpose();
      ++cluster_count;
    }
    cluster.setZero();
  };
  const auto ranges = ranges_of(problem);
  for (std::size_t frame = 0; frame < ranges.size(); ++frame) {
    // The frame's own pose is eliminated.
    Matrix6d of_frame = Matrix6d::Zero();
    Vector6d of_frame_right = Vector6d::Zero();
    Eigen::MatrixXd between = Eigen::MatrixXd::Zero(size, 6), of_markers = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    const RigidTransform& pose = solution.camera_from_body[frame];
    int used = 0;
    for (std::size_t v = ranges[frame].first; v < ranges[frame].second; ++v) {
      if (!solution.is_inlier[v]) continue;
      const RigView& view = problem.views[v];
      const RigidTransform& at = solution.reference_from_marker[view.marker];
      const auto residual = residual_of(problem, view, pose, at);
      if (!residual) continue;
      Matrix86d d_frame, d_marker;
      const auto corners_mm = rig_corners_mm(problem.size_mm[view.marker]);
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector3d in_body = at * corners_mm[k], in_camera = pose * in_body;
        Eigen::Matrix<double, 2, 3> d_pixel;
        d_pixel << 1, 0, -in_camera.x() / in_camera.z(), 0, 1, -in_camera.y() / in_camera.z();
        d_pixel *= kRigFocal_px / in_camera.z();
        const Eigen::Matrix<double, 2, 3> by_body = d_pixel * pose.matrix(),
                                          by_marker = by_body * at.matrix();
        const auto row = static_cast<Eigen::Index>(2 * k);
        d_frame.block<2, 6>(row, 0) << by_body, -by_body * geometry::cross_matrix(in_body);
        d_marker.block<2, 6>(row, 0) << by_marker, -by_marker * geometry::cross_matrix(corners_mm[k]);
      }
      ++used;
      squares += residual->squaredNorm();
      of_frame += d_frame.transpose() * d_frame;
      of_frame_right += d_frame.transpose() * *residual;
      if (view.marker == 0) continue;
      const auto first = static_cast<Eigen::Index>(6 * (view.marker - 1));
      between.middleRows(first, 6) += d_marker.transpose() * d_frame;
      of_markers.block(first, first, 6, 6) += d_marker.transpose() * d_marker;
      right.segment(first, 6) += d_marker.transpose() * *residual;
    }
    if (used < 2) continue;
    freedom += 8L * used - 6;
    const Eigen::LDLT<Matrix6d> solver(of_frame);
    information += of_markers - between * solver.solve(between.transpose());
    if (problem.time_s[frame] - cluster_begin_s > kCluster_s) {
      end_cluster();
      cluster_begin_s = problem.time_s[frame];
    }
    cluster += right - between * solver.solve(of_frame_right);
  }
  end_cluster();
  const Eigen::MatrixXd inverse = information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::MatrixXd alone = squares / static_cast<double>(std::max(1L, freedom)) * inverse;
  if (cluster_count < 2) return alone;
  const double few = static_cast<double>(cluster_count) / static_cast<double>(cluster_count - 1);
  const Eigen::MatrixXd together = few * inverse * spread * inverse;
  // A short wave has few clusters: they tell how large the errors are, not in which direction.
  Eigen::VectorXd wider(size);
  for (Eigen::Index first = 0; first < size; first += 3) {
    const double more =
        together.diagonal().segment<3>(first).sum() / alone.diagonal().segment<3>(first).sum();
    wider.segment<3>(first).setConstant(std::sqrt(std::max(1.0, more)));
  }
  return wider.asDiagonal() * alone * wider.asDiagonal();
}

double rig_rms_mm(const RigProblem& problem, const RigSolution& solution) {
  double squares = 0;
  long count = 0;
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    if (!solution.is_inlier[v]) continue;
    const RigView& view = problem.views[v];
    const double depth_mm = view.camera_from_marker.translation_mm.z();
    // The distance of a corner, not of a coordinate.
    squares += 2 * std::pow(rms_px(problem, solution, view) * depth_mm / kRigFocal_px, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : -1;
}

}  // namespace arthronaut::tools
