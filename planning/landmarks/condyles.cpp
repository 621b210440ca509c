#include "planning/landmarks/condyles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// The condyles lie within it of the lowest point; what is nearer to the mirror plane belongs to the notch.
constexpr double kJointEnd_mm = 42, kInner_mm = 8;
// Of the directions: 0 straight back, 90 straight down.
constexpr int kFirst_deg = -10, kLast_deg = 100, kStep_deg = 10;
constexpr int kRounds = 12;

struct Halves {
  std::vector<Vector3d> minus, plus;
  double hindmost = 1e9, foremost = -1e9, lowest = 1e9;
};

Halves halves_of(const std::vector<SurfaceSample>& samples, const Matrix3d& axes, const Vector3d& middle) {
  Halves halves;
  for (const auto& s : samples)
    halves.lowest = std::min(halves.lowest, (s.point_mm - middle).dot(axes.col(2)));
  for (const auto& s : samples) {
    const Vector3d q = axes.transpose() * (s.point_mm - middle);
    if (q.z() > halves.lowest + kJointEnd_mm) continue;
    halves.hindmost = std::min(halves.hindmost, q.y());
    halves.foremost = std::max(halves.foremost, q.y());
    if (q.x() < -kInner_mm) halves.minus.push_back(s.point_mm);
    if (q.x() > kInner_mm) halves.plus.push_back(s.point_mm);
  }
  return halves;
}

// Everything but the frame's direction and the misfit.
void measure(Condyles& condyles, const Halves& halves, double each_mm2) {
  const Matrix3d& axes = condyles.bone_from_frame;
  const Vector3d behind = -axes.col(1), below = -axes.col(2);
  condyles.posterior_minus = *furthest(halves.minus, behind, each_mm2);
  condyles.posterior_plus = *furthest(halves.plus, behind, each_mm2);
  condyles.distal_minus = *furthest(halves.minus, below, each_mm2);
  condyles.distal_plus = *furthest(halves.plus, below, each_mm2);
  condyles.depth_mm = halves.foremost - halves.hindmost;
  const double third = 0.33 * condyles.depth_mm;
  const Vector3d posterior = (condyles.posterior_minus + condyles.posterior_plus) / 2,
                 distal = (condyles.distal_minus + condyles.distal_plus) / 2;
  condyles.center_mm = posterior.dot(axes.col(0)) * axes.col(0) +
                       (posterior.dot(axes.col(1)) + third) * axes.col(1) +
                       (distal.dot(axes.col(2)) + third) * axes.col(2);
}

bool is_too_few(const Halves& halves, double each_mm2) {
  constexpr double kLeast_mm2 = 100;
  return static_cast<double>(std::min(halves.minus.size(), halves.plus.size())) * each_mm2 < kLeast_mm2;
}

}  // namespace

std::optional<Condyles> find_condyles(const std::vector<SurfaceSample>& samples, double each_mm2,
                                      const Matrix3d& bone_from_frame, const Vector3d& origin_mm) {
  Condyles result;
  Matrix3d& axes = result.bone_from_frame;
  axes = bone_from_frame;
  result.center_mm = origin_mm;
  for (int round = 0; round < kRounds; ++round) {
    const Halves halves = halves_of(samples, axes, result.center_mm);
    if (is_too_few(halves, each_mm2)) return std::nullopt;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Vector2d right = Vector2d::Zero();
    double squares = 0, count = 0;
    for (int degrees = kFirst_deg; degrees <= kLast_deg; degrees += kStep_deg) {
      const double angle = geometry::rad_from_deg(degrees);
      const Vector3d direction = -std::cos(angle) * axes.col(1) - std::sin(angle) * axes.col(2);
      const Vector3d apart =
          *furthest(halves.plus, direction, each_mm2) - *furthest(halves.minus, direction, each_mm2);
      // Turning x by small angles towards y and z takes this much off what is left along the direction.
      const Vector2d row = Vector2d(-std::cos(angle), -std::sin(angle)) * apart.dot(axes.col(0));
      normal += row * row.transpose();
      right += row * apart.dot(direction);
      squares += std::pow(apart.dot(direction), 2);
      count += 1;
    }
    result.misfit_mm = std::sqrt(squares / count);
    measure(result, halves, each_mm2);
    if (round == kRounds - 1) break;
    const Vector2d turn = normal.ldlt().solve(right);
    const Vector3d x = (axes.col(0) + turn.x() * axes.col(1) + turn.y() * axes.col(2)).normalized();
    const Vector3d z = (axes.col(2) - axes.col(2).dot(x) * x).normalized();
    axes.col(0) = x;
    axes.col(1) = z.cross(x);
    axes.col(2) = z;
  }
  const double apart = (result.posterior_plus - result.posterior_minus).dot(axes.col(0));
  if (result.depth_mm < 40 || result.depth_mm > 100 || apart < 25 || apart > 80) return std::nullopt;
  return result;
}

}  // namespace arthronaut::landmarks
