#include "navigation/markers/edge_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/markers/verdict.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::markers {
namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;

constexpr int kIterations = 10;
constexpr int kMinEdges = 12;
constexpr int kMaxEdges = 1024;
// A step that moves every edge by less than this changes their distances as its derivatives say.
constexpr double kLinearPx = 0.1;
constexpr double kMinTellingShare = 0.5;
constexpr double kTukey = 4.685;
// Neighbouring profiles share pixels and what is wrong with them: so many of them count as one.
constexpr double kCorrelatedEdges = 2.2;
// What every edge of a side has wrong together (camera, print, compression), as an error of the corners.
constexpr double kCommonCornerErrorPx = 0.010;

// Corners that another pose meets so closely do not tell it from this one; all edges together do, by so much.
// Of a fit whose edges are farther off than they should be by this factor the corners tell nothing.
constexpr double kNearlySamePx = 1, kMinChiSquared = 16, kPoorScale = 1.2;

// By how much the half of a marker may be off from all of it: squared, by what both are known to, a
// direction.
constexpr double kMaxHalfSquare = 1.5;

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

// Which way along its normal an edge moves when the dark grows.
double growth_of(const EdgeSample& sample) { return sample.cells[1] < sample.cells[2] ? 1 : -1; }

// Signed distance (measured less projected) of an edge, and the derivatives of the projected place.
struct Row {
  Vector7d jacobian;  // body twist, bloom
  double residual_px = 0;
};

// False: behind the camera.
bool find_row(const camera::CameraModel& camera, double size_mm, const EdgeSample& sample,
              const EdgeMeasurement& measurement, const RigidTransform& pose, const Eigen::Matrix3d& rotation,
              double bloom_px, Row& row) {
  const Eigen::Vector3d place(sample.x * size_mm, sample.y * size_mm, 0);
  Eigen::Matrix<double, 2, 3> d_pixel;
  const auto pixel = camera.project(rotation * place + pose.translation_mm, d_pixel);
  if (!pixel) return false;
  const Eigen::RowVector3d across = measurement.normal.transpose() * d_pixel * rotation;
  row.jacobian.head<3>() = across.transpose();
  // -across * [place]x
  row.jacobian.segment<3>(3) = place.cross(across.transpose());
  row.jacobian[6] = growth_of(sample);
  row.residual_px = measurement.offset_px - measurement.normal.dot(*pixel - measurement.point_px) -
                    bloom_px * row.jacobian[6];
  return true;
}

double tukey_weight(double ratio) {
  if (std::abs(ratio) >= kTukey) return 0;
  const double left = 1 - ratio * ratio / (kTukey * kTukey);
  return left * left;
}

}  // namespace

EdgePose fit_edge_pose(const camera::CameraModel& camera, double size_mm, std::span<const EdgeSample> samples,
                       std::span<const EdgeMeasurement> measurements, const RigidTransform& start,
                       const BloomPrior& bloom_prior, std::vector<char>& is_inlier) {
  EdgePose result;
  RigidTransform pose = start;
  std::array<double, kMaxEdges> ratios;
  is_inlier.assign(measurements.size(), 0);
  Matrix7d normal;
  double bloom = bloom_prior.mean_px;
  double scale = 1, squares = 0, weights = 0, px_squares = 0;
  std::array<Row, kMaxEdges> rows;
  std::array<int, kMaxEdges> of_row;  // its measurement
  int count = 0;
  bool is_linear = false;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!is_linear) {
      const Eigen::Matrix3d rotation = pose.matrix();
      count = 0;
      for (std::size_t i = 0; i < measurements.size(); ++i) {
        const EdgeMeasurement& measurement = measurements[i];
        if (measurement.state != EdgeState::Found || count == kMaxEdges) continue;
        if (!find_row(camera, size_mm, samples[measurement.sample], measurement, pose, rotation, bloom,
                      rows[count]))
          return result;
        of_row[count++] = static_cast<int>(i);
      }
    }
    for (int r = 0; r < count; ++r)
      ratios[r] = std::abs(rows[r].residual_px) / measurements[of_row[r]].sigma_px;
    if (count < kMinEdges) return result;
    scale = std::max(
        1.0, 1.4826 * geometry::median_in_place(std::span(ratios).first(static_cast<std::size_t>(count))));

    const double bloom_weight = 1 / (bloom_prior.sigma_px * bloom_prior.sigma_px);
    normal.setZero();
    normal(6, 6) = bloom_weight;
    Vector7d gradient = Vector7d::Zero();
    gradient[6] = bloom_weight * (bloom_prior.mean_px - bloom);
    squares = weights = px_squares = 0;
    result.inliers = 0;
    for (int r = 0; r < count; ++r) {
      const Row& row = rows[r];
      const double sigma_px = measurements[of_row[r]].sigma_px;
      const double ratio = row.residual_px / sigma_px;
      const double robust = tukey_weight(ratio / scale);
      is_inlier[of_row[r]] = robust > 0;
      if (robust <= 0) continue;
      const double weight = robust / (sigma_px * sigma_px);
      // The half that is looked at.
      const Vector7d weighed = weight * row.jacobian;
      for (int column = 0; column < 7; ++column) {
        for (int k = column; k < 7; ++k) normal(k, column) += weighed[k] * row.jacobian[column];
      }
      gradient.noalias() += weight * row.residual_px * row.jacobian;
      squares += robust * ratio * ratio;
      weights += robust;
      px_squares += row.residual_px * row.residual_px;
      ++result.inliers;
    }
    if (result.inliers < kMinEdges) return result;
    Matrix7d damped = normal;
    damped.diagonal() *= 1 + 1e-9;
    const Vector7d step = damped.ldlt().solve(gradient);
    if (!step.allFinite() || step.head<3>().norm() > 5 || step.segment<3>(3).norm() > 0.5) return result;
    pose = pose * geometry::exp(step.head<6>());
    bloom += step[6];
    if (!(pose.translation_mm.z() > 0)) return result;
    double most_px = 0;
    for (int r = 0; r < count; ++r) {
      const double moved_px = rows[r].jacobian.dot(step);
      rows[r].residual_px -= moved_px;
      most_px = std::max(most_px, std::abs(moved_px));
    }
    is_linear = most_px < kLinearPx;
    if (iteration >= 2 && step.head<3>().norm() < 1e-5 && step.segment<3>(3).norm() < 1e-6) break;
  }

  result.converged = true;
  result.camera_from_marker = pose;
  result.bloom_px = bloom;
  result.scale = std::sqrt(squares / std::max(1.0, weights - 6));
  result.rms_px = std::sqrt(px_squares / result.inliers);
  // What is saturated speaks neither for nor against the pose, as long as it is not the most of it.
  std::array<int, 2> seen{}, saturated{}, agreeing{};
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    if (measurements[i].state == EdgeState::OutOfView) continue;
    const int axis = samples[measurements[i].sample].axis;
    ++seen[axis];
    saturated[axis] += measurements[i].state == EdgeState::Saturated;
    agreeing[axis] += is_inlier[i];
  }
  for (int axis = 0; axis < 2; ++axis) {
    const double telling = std::max(double(seen[axis] - saturated[axis]), kMinTellingShare * seen[axis]);
    result.share[axis] = telling > 0 ? agreeing[axis] / telling : 0;
  }

  const double inflation = kCorrelatedEdges * std::max(0.25, result.scale * result.scale);
  result.covariance = inflation * Matrix7d(normal.ldlt().solve(Matrix7d::Identity())).topLeftCorner<6, 6>();
  // The common error of the corners, spread over the directions that the corners determine.
  Matrix6d corner_normal = Matrix6d::Zero();
  const Eigen::Matrix3d rotation = pose.matrix();
  for (const Eigen::Vector3d& corner : square_corners_mm(size_mm)) {
    Eigen::Matrix<double, 2, 3> d_pixel;
    if (!camera.project(pose * corner, d_pixel)) continue;
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian.leftCols<3>() = d_pixel * rotation;
    jacobian.rightCols<3>() = -d_pixel * rotation * geometry::cross_matrix(corner);
    corner_normal.noalias() += jacobian.transpose() * jacobian;
  }
  result.covariance +=
      kCommonCornerErrorPx * kCommonCornerErrorPx * corner_normal.ldlt().solve(Matrix6d::Identity());
  if (!result.covariance.allFinite()) result.converged = false;
  return result;
}

std::optional<EdgePose> rival_tilt(const camera::CameraModel& camera, double size_mm,
                                   std::span<const EdgeSample> samples,
                                   std::span<const EdgeMeasurement> measurements, const EdgePose& fit,
                                   const Corners& corners_px, const BloomPrior& bloom,
                                   std::vector<char>& scratch) {
  const auto corners = refine_square_pose(camera, corners_px, size_mm, tilted_back(fit.camera_from_marker));
  if (!corners) return std::nullopt;
  const bool are_near = corners->rms_px <= kNearlySamePx;
  if (!are_near && fit.scale < kPoorScale) return std::nullopt;
  const EdgePose other =
      fit_edge_pose(camera, size_mm, samples, measurements, corners->camera_from_marker, bloom, scratch);
  if (!other.converged ||
      geometry::rotation_angle_rad(fit.camera_from_marker.rotation.conjugate() *
                                   other.camera_from_marker.rotation) < kHarmlessTiltRad) {
    return std::nullopt;
  }
  const double noise = std::max(1.0, std::min(fit.scale, other.scale));
  const auto square = [noise](const EdgePose& pose) { return std::pow(pose.scale / noise, 2); };
  // An edge that a pose leaves out speaks against it, by what Tukey's cost is at most.
  const int most = std::max(fit.inliers, other.inliers);
  const auto cost = [&](const EdgePose& pose) {
    return pose.inliers * square(pose) + (most - pose.inliers) * kTukey * kTukey / 3;
  };
  double told = cost(other) - cost(fit);
  if (are_near) told = std::min(told, std::min(fit.inliers, other.inliers) * (square(other) - square(fit)));
  if (told >= kMinChiSquared * kCorrelatedEdges) return std::nullopt;
  return other;
}

std::optional<Matrix6d> doubt_by_halves(const camera::CameraModel& camera, double size_mm,
                                        std::span<const EdgeSample> samples,
                                        std::span<const EdgeMeasurement> measurements, const EdgePose& fit,
                                        const BloomPrior& bloom, std::vector<EdgeMeasurement>& half,
                                        std::vector<char>& scratch) {
  Matrix6d doubt = Matrix6d::Zero();
  for (double EdgeSample::*coordinate : {&EdgeSample::x, &EdgeSample::y}) {
    double least_square = std::numeric_limits<double>::infinity();
    Vector6d apart_least = Vector6d::Zero();
    for (const double sign : {-1.0, 1.0}) {
      if (least_square < kMaxHalfSquare) break;
      half.clear();
      for (const EdgeMeasurement& edge : measurements) {
        if (edge.state == EdgeState::Found && sign * samples[edge.sample].*coordinate >= 0)
          half.push_back(edge);
      }
      const EdgePose by_half =
          fit_edge_pose(camera, size_mm, samples, half, fit.camera_from_marker, bloom, scratch);
      if (!by_half.converged) {
        least_square = 0;
        break;
      }
      const Vector6d apart = geometry::log(fit.camera_from_marker.inverse() * by_half.camera_from_marker);
      const double square = apart.dot((fit.covariance + by_half.covariance).ldlt().solve(apart)) / 6;
      if (square >= least_square) continue;
      least_square = square;
      apart_least = apart;
    }
    if (least_square >= kMaxHalfSquare) doubt += apart_least * apart_least.transpose();
  }
  return is_known_well_enough(doubt) ? std::optional(doubt) : std::nullopt;
}

RowTrend row_trend(const camera::CameraModel& camera, double size_mm, std::span<const EdgeSample> samples,
                   std::span<const EdgeMeasurement> measurements, std::span<const char> is_inlier,
                   const EdgePose& pose) {
  const Eigen::Matrix3d rotation = pose.camera_from_marker.matrix();
  Matrix7d normal = Matrix7d::Identity() * 1e-9;
  Eigen::Matrix<double, 7, 4> mixed = Eigen::Matrix<double, 7, 4>::Zero();  // by delays, by motion
  Vector7d pull = Vector7d::Zero();
  RowTrend trend;
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const EdgeMeasurement& edge = measurements[i];
    Row row;
    if (!is_inlier[i] || !find_row(camera, size_mm, samples[edge.sample], edge, pose.camera_from_marker,
                                   rotation, pose.bloom_px, row))
      continue;
    const double weight = 1 / (edge.sigma_px * edge.sigma_px);
    normal.noalias() += weight * row.jacobian * row.jacobian.transpose();
    mixed.leftCols<2>().noalias() += weight * row.jacobian * edge.by_delays_px.transpose();
    mixed.rightCols<2>().noalias() += weight * row.jacobian * (edge.row_share * edge.normal).transpose();
    trend.weight.noalias() += weight * edge.by_delays_px * edge.by_delays_px.transpose();
    trend.gain += weight * row.residual_px * edge.by_delays_px;
    pull += weight * row.residual_px * row.jacobian;
    squares += weight * row.residual_px * row.residual_px;
    count += 1;
  }
  // As far as no other pose explains the same.
  const Eigen::Matrix<double, 7, 4> explained = normal.ldlt().solve(mixed);
  trend.twist_by_delays = explained.topLeftCorner<6, 2>();
  trend.twist_by_motion = explained.topRightCorner<6, 2>();
  trend.weight -= mixed.leftCols<2>().transpose() * explained.leftCols<2>();
  trend.gain -= explained.leftCols<2>().transpose() * pull;
  const double inflation = kCorrelatedEdges * std::max(1.0, squares / std::max(1.0, count - 9));
  trend.weight /= inflation;
  trend.gain /= inflation;
  return trend;
}

MeasuredCorners measured_corners(const camera::CameraModel& camera, double size_mm,
                                 std::span<const EdgeSample> samples,
                                 std::span<const EdgeMeasurement> measurements,
                                 std::span<const char> is_inlier, const EdgePose& pose) {
  const RigidTransform& camera_from_marker = pose.camera_from_marker;
  // Per side: deviation = a + b * along, with along from -0.5 to 0.5.
  struct Line {
    double n = 0, t = 0, tt = 0, e = 0, te = 0;
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    [[nodiscard]] double at(double along) const {
      const double det = n * tt - t * t;
      if (n < 5 || det < 0.02 * n * n) return 0;
      return ((tt * e - t * te) + (n * te - t * e) * along) / det;
    }
  };
  std::array<Line, 4> lines;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const EdgeSample& sample = samples[measurements[i].sample];
    if (sample.side < 0 || !is_inlier[i]) continue;
    const auto pixel =
        camera.project(camera_from_marker * Eigen::Vector3d(sample.x * size_mm, sample.y * size_mm, 0));
    if (!pixel) continue;
    const double deviation = measurements[i].offset_px -
                             measurements[i].normal.dot(*pixel - measurements[i].point_px) -
                             pose.bloom_px * growth_of(sample);
    const double along = sample.axis == 0 ? sample.y : sample.x;
    Line& line = lines[sample.side];
    line.n += 1;
    line.t += along;
    line.tt += along * along;
    line.e += deviation;
    line.te += along * deviation;
    line.normal += measurements[i].normal;
  }
  MeasuredCorners result;
  const auto corners_mm = square_corners_mm(size_mm);
  double squares = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const auto pixel = camera.project(camera_from_marker * corners_mm[corner]);
    result.corners_px[corner] = pixel.value_or(Eigen::Vector2d::Zero());
    // Corner k lies between the sides k-1 and k (top, right, bottom, left).
    const Line &before = lines[(corner + 3) % 4], &after = lines[corner];
    const bool before_is_vertical = (corner + 3) % 2 == 1;
    const double x = corners_mm[corner].x() / size_mm, y = corners_mm[corner].y() / size_mm;
    Eigen::Matrix2d normals;
    normals.row(0) = before.normal.normalized().transpose();
    normals.row(1) = after.normal.normalized().transpose();
    if (!(std::abs(normals.determinant()) > 0.1)) continue;
    const Eigen::Vector2d deviations(before.at(before_is_vertical ? y : x),
                                     after.at(before_is_vertical ? x : y));
    const Eigen::Vector2d moved = normals.inverse() * deviations;
    result.corners_px[corner] += moved;
    squares += moved.squaredNorm();
  }
  result.rms_px = std::sqrt(squares / 4);
  return result;
}

}  // namespace arthronaut::markers
