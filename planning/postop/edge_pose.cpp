#include "planning/postop/edge_pose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "planning/geometry/quantile.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;
using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kStep_mm = 0.25;
// An edge parts what is so far inside from what is so far outside, and falls by so much.
constexpr int kSide = 5;
constexpr double kLeastFall_hu = 100;
// An edge is taken for the surface's up to here.
constexpr double kOnEdge_mm = 1.0, kReach_mm = 3.0;
// Edges near to each other are wrong together.
constexpr double kCorrelated = 10;

struct Edge {
  bool is_in_view = false;
  std::optional<double> outward_mm;  // of the sample's place
  double height_hu = 0;              // from what lies beside it to the cortex
};

Edge edge_at(const images::VolumeSampler& postop, const Vector3d& q, const Vector3d& outward,
             double reach_mm) {
  const int reach = static_cast<int>(std::lround(reach_mm / kStep_mm)), room = reach + kSide + 1,
            count = 2 * room + 1;
  std::vector<double> profile(static_cast<std::size_t>(count)), until(static_cast<std::size_t>(count) + 1, 0);
  Edge edge;
  for (int i = 0; i < count; ++i) {
    const double v = postop.at(q + (i - room) * kStep_mm * outward);
    if (!std::isfinite(v)) return edge;
    profile[static_cast<std::size_t>(i)] = v;
    until[static_cast<std::size_t>(i) + 1] = until[static_cast<std::size_t>(i)] + v;
  }
  edge.is_in_view = true;
  const auto mean = [&](int from, int to) {
    return (until[static_cast<std::size_t>(to)] - until[static_cast<std::size_t>(from)]) / (to - from);
  };
  double best = 0;
  int at = -1;
  for (int i = room - reach; i <= room + reach; ++i) {
    const double fall = mean(i - kSide, i) - mean(i + 1, i + 1 + kSide);
    if (fall < kLeastFall_hu) continue;
    const double off = (i - room) * kStep_mm / (0.6 * reach_mm);
    const double score = std::min(fall, 600.0) * std::exp(-0.5 * off * off);
    if (score <= best) continue;
    best = score;
    at = i;
  }
  if (at < 0) return edge;
  const auto begin = profile.begin() + at - kSide, middle = profile.begin() + at,
             end = profile.begin() + at + kSide + 1;
  const double cortex = *std::max_element(begin, middle + 1), beside = *std::min_element(middle, end),
               level = 0.5 * (cortex + beside);
  edge.height_hu = cortex - beside;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = at - kSide; i < at + kSide; ++i) {
    const double inner = profile[static_cast<std::size_t>(i)],
                 outer = profile[static_cast<std::size_t>(i) + 1];
    if (inner < level || outer >= level) continue;
    const double place = i + (inner - level) / (inner - outer);
    if (std::abs(place - at) < std::abs(nearest - at)) nearest = place;
  }
  if (std::isfinite(nearest)) edge.outward_mm = (nearest - room) * kStep_mm;
  return edge;
}

struct Seen {
  Vector3d q, normal;
  double outward_mm, height_hu;
};

struct Look {
  std::vector<Seen> edges;
  std::size_t in_view = 0;
};

Look look(const images::VolumeSampler& postop, std::span<const SurfaceSample> samples,
          const RigidTransform& pose, double reach_mm) {
  Look result;
  for (const SurfaceSample& sample : samples) {
    const Vector3d q = pose * sample.point_mm, n = pose.rotate(sample.normal);
    const Edge edge = edge_at(postop, q, n, reach_mm);
    result.in_view += edge.is_in_view ? 1 : 0;
    if (edge.outward_mm) result.edges.push_back({q, n, *edge.outward_mm, edge.height_hu});
  }
  return result;
}

double scale_of(const std::vector<Seen>& edges) {
  std::vector<double> off;
  off.reserve(edges.size());
  for (const Seen& edge : edges) off.push_back(std::abs(edge.outward_mm));
  return std::max(0.08, 1.4826 * geometry::median(std::move(off), 1));
}

Vector3d middle_of(const std::vector<Seen>& edges) {
  Vector3d sum = Vector3d::Zero();
  for (const Seen& edge : edges) sum += edge.q;
  return sum / std::max<double>(1, static_cast<double>(edges.size()));
}

// One step of point-to-plane.
Matrix6d step(const std::vector<Seen>& edges, double scale_mm, const Vector3d& center, RigidTransform& pose) {
  Matrix6d normal = Matrix6d::Identity() * 1e-6;
  Vector6d right = Vector6d::Zero();
  for (const Seen& edge : edges) {
    const double ratio = edge.outward_mm / (4.685 * scale_mm);
    if (std::abs(ratio) >= 1) continue;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    Vector6d row;
    row << edge.normal, (edge.q - center).cross(edge.normal);
    normal += weight * row * row.transpose();
    right += weight * edge.outward_mm * row;
  }
  const Vector6d change = normal.ldlt().solve(right);
  const Vector3d turn = change.tail<3>();
  const double angle = turn.norm();
  const Eigen::Quaterniond rotation(angle > 1e-12 ? Eigen::AngleAxisd(std::min(angle, 0.2), turn / angle)
                                                  : Eigen::AngleAxisd::Identity());
  pose = {(rotation * pose.rotation).normalized(),
          rotation * (pose.translation_mm - center) + center + Vector3d(change.head<3>())};
  return normal;
}

// Sum of both curvatures, 1/mm, convex positive, as the edges about it tell; 0 where they are too few.
double curvature_at(const Seen& edge, const std::vector<Seen>& edges) {
  constexpr double kNear_mm = 4, kTooNear_mm = 0.2, kMost = 0.8;
  double sum = 0;
  int count = 0;
  for (const Seen& other : edges) {
    const Vector3d apart = other.q - edge.q;
    const double square = apart.squaredNorm();
    if (square < kTooNear_mm * kTooNear_mm || square > kNear_mm * kNear_mm) continue;
    sum += (other.normal - edge.normal).dot(apart) / square;
    ++count;
  }
  return count > 3 ? std::clamp(2 * sum / count, -kMost, kMost) : 0;
}

// Of the fit of a pose, a strain, an offset all over (another threshold, another scanner), one by how curved
// the surface is (a blurred convex edge lies further in), and an offset where the cortex is thin, at once:
// through the scanner's blur a thin cortex is lower, and half-way down lies further out. Where it is thin
// differs from place to place, which would pass for a strain.
double stretch_of(const std::vector<Seen>& edges, double most_mm) {
  using Row = Eigen::Matrix<double, 15, 1>;
  Eigen::Matrix<double, 15, 15> normal = Eigen::Matrix<double, 15, 15>::Identity() * 1e-9;
  Row right = Row::Zero();
  const Vector3d center = middle_of(edges);
  constexpr double kUnit_mm = 40;  // keeps the columns alike
  std::vector<double> heights;
  for (const Seen& edge : edges) heights.push_back(edge.height_hu);
  const double full = std::max(1.0, geometry::quantile(std::move(heights), 0.9, 0));
  for (const Seen& edge : edges) {
    if (std::abs(edge.outward_mm) > most_mm) continue;
    const Vector3d x = (edge.q - center) / kUnit_mm, &n = edge.normal;
    Row row;
    row << n, x.cross(n), n.x() * x.x(), n.y() * x.y(), n.z() * x.z(), n.x() * x.y() + n.y() * x.x(),
        n.y() * x.z() + n.z() * x.y(), n.z() * x.x() + n.x() * x.z(), 1,
        std::max(0.0, 1 - edge.height_hu / full), curvature_at(edge, edges);
    normal += row * row.transpose();
    right += edge.outward_mm * row;
  }
  const Row fit = normal.ldlt().solve(right);
  Eigen::Matrix3d strain;
  strain << fit[6], fit[9], fit[11], fit[9], fit[7], fit[10], fit[11], fit[10], fit[8];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(strain / kUnit_mm)
      .eigenvalues()
      .cwiseAbs()
      .maxCoeff();
}

}  // namespace

double EdgePose::sigma_at_mm(const Vector3d& p_in_plan) const {
  Eigen::Matrix<double, 3, 6> by_pose;
  by_pose << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(postop_from_plan * p_in_plan - center_mm);
  return std::sqrt(std::max(0.0, (by_pose * covariance * by_pose.transpose()).trace()));
}

double EdgePose::sigma_of_direction_rad(const Vector3d& in_plan) const {
  const Eigen::Matrix3d by_turn = geometry::cross_matrix(postop_from_plan.rotation * in_plan);
  return std::sqrt(
      std::max(0.0, (by_turn * covariance.bottomRightCorner<3, 3>() * by_turn.transpose()).trace()));
}

EdgePose edge_pose(const images::VolumeSampler& postop, std::span<const SurfaceSample> samples,
                   const RigidTransform& postop_from_plan) {
  struct Round {
    double reach_mm;
    int steps;
    std::size_t samples;
  };
  EdgePose result;
  result.postop_from_plan = postop_from_plan;
  for (const Round& round : {Round{6, 8, 500}, Round{3, 6, 1000}, Round{1.5, 5, samples.size()}}) {
    for (int i = 0; i < round.steps; ++i) {
      const Look seen = look(postop, samples.first(std::min(round.samples, samples.size())),
                             result.postop_from_plan, round.reach_mm);
      if (seen.edges.size() < 50) return result;
      result.center_mm = middle_of(seen.edges);
      const double scale = scale_of(seen.edges);
      const Matrix6d normal = step(seen.edges, scale, result.center_mm, result.postop_from_plan);
      result.covariance = (scale * scale * kCorrelated * normal.inverse()).eval();
    }
  }
  const Look seen = look(postop, samples, result.postop_from_plan, kReach_mm);
  std::vector<double> off;
  std::size_t near = 0;
  for (const Seen& edge : seen.edges) {
    off.push_back(std::abs(edge.outward_mm));
    near += std::abs(edge.outward_mm) <= kOnEdge_mm ? 1 : 0;
  }
  const double most = geometry::quantile(off, 0.9, 0);
  double squares = 0, sum = 0;
  std::size_t counted = 0;
  for (const Seen& edge : seen.edges) {
    if (std::abs(edge.outward_mm) > most) continue;
    squares += edge.outward_mm * edge.outward_mm;
    sum += edge.outward_mm;
    ++counted;
  }
  if (counted == 0) return result;
  result.rms_mm = std::sqrt(squares / static_cast<double>(counted));
  result.bias_mm = sum / static_cast<double>(counted);
  result.spread_mm =
      std::sqrt(std::max(0.0, result.rms_mm * result.rms_mm - result.bias_mm * result.bias_mm));
  result.stretch = stretch_of(seen.edges, std::max(most, kOnEdge_mm));
  result.in_view_share = static_cast<double>(seen.in_view) / static_cast<double>(samples.size());
  result.on_edge_share =
      static_cast<double>(near) / static_cast<double>(std::max<std::size_t>(1, seen.in_view));
  return result;
}

}  // namespace arthronaut::postop
