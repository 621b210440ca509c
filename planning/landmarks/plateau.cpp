#include "planning/landmarks/plateau.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace arthronaut::landmarks {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDeepest_mm = -30, kAbove_mm = 40;
constexpr double kRim_mm = 6;     // below the plane: over the edge
constexpr double kInner_mm = 10;  // to either side of the middle: eminences
constexpr double kLeastHalf_mm2 = 250;
constexpr int kRounds = 10;

Relief look_from_above(const geometry::Surface& tibia, const Matrix3d& axes, const Vector3d& origin) {
  Relief relief;
  constexpr int kSide = 2 * Relief::kHalf + 1;
  relief.height_mm.assign(static_cast<std::size_t>(kSide * kSide), Relief::kEmpty);
  for (int row = -Relief::kHalf; row <= Relief::kHalf; ++row) {
    for (int column = -Relief::kHalf; column <= Relief::kHalf; ++column) {
      const Vector3d from =
          origin + axes * Vector3d(column * Relief::kCell_mm, row * Relief::kCell_mm, kAbove_mm);
      const auto hit = tibia.first_hit(from, -axes.col(2));
      if (!hit || hit->normal.dot(axes.col(2)) < 0 || kAbove_mm - hit->distance_mm < kDeepest_mm) continue;
      relief.height_mm[static_cast<std::size_t>((row + Relief::kHalf) * kSide + column + Relief::kHalf)] =
          kAbove_mm - hit->distance_mm;
    }
  }
  return relief;
}

template <typename Visit>
void each_cell(const Relief& relief, const Visit& visit) {
  for (int row = -Relief::kHalf; row <= Relief::kHalf; ++row) {
    for (int column = -Relief::kHalf; column <= Relief::kHalf; ++column) {
      const double height = relief.at(column, row);
      if (height != Relief::kEmpty)
        visit(Vector2d(column * Relief::kCell_mm, row * Relief::kCell_mm), height);
    }
  }
}

// Height over x and y by least squares, with weights that let go of what lies off the plane.
Vector3d fit_plane(const Relief& relief, const Vector3d& before, double scale_mm) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  each_cell(relief, [&](const Vector2d& at, double height) {
    if (std::abs(at.x()) < kInner_mm || std::abs(at.x()) > 34 || std::abs(at.y()) > 24) return;
    const Vector3d row(at.x(), at.y(), 1);
    const double off = (height - row.dot(before)) / scale_mm;
    if (std::abs(off) >= 1) return;
    const double weight = std::pow(1 - off * off, 2);
    normal += weight * row * row.transpose();
    right += weight * row * height;
  });
  return normal.ldlt().solve(right);
}

}  // namespace

std::optional<Plateau> find_plateau(const geometry::Surface& tibia, const RoughFrame& rough) {
  Plateau plateau;
  Matrix3d& axes = plateau.bone_from_frame;
  axes = rough.bone_from_frame;
  Vector3d& origin = plateau.origin_mm;
  origin = rough.origin_mm - 8 * axes.col(2);
  for (int round = 0; round < kRounds; ++round) {
    plateau.relief = look_from_above(tibia, axes, origin);
    Vector3d plane(0, 0, 0);
    if (round == 0) {  // the eminences were the top: the median is the plateau's height
      std::vector<double> heights;
      each_cell(plateau.relief, [&](const Vector2d& at, double height) {
        if (std::abs(at.x()) > kInner_mm) heights.push_back(height);
      });
      if (heights.size() < 200) return std::nullopt;
      const auto at =
          heights.begin() + static_cast<std::ptrdiff_t>(0.6 * static_cast<double>(heights.size()));
      std::nth_element(heights.begin(), at, heights.end());
      plane.z() = *at;
    }
    const double scale = round < 3 ? 8 : 5;
    for (int k = 0; k < 6; ++k) plane = fit_plane(plateau.relief, plane, scale);
    if (!plane.allFinite() || plane.head<2>().norm() > 1) return std::nullopt;
    // The halves' middles: of their areas down to the rim.
    struct Half {
      Vector2d sum = Vector2d::Zero();
      double cells = 0;
    } minus, plus;
    each_cell(plateau.relief, [&](const Vector2d& at, double height) {
      if (height < plane.dot(Vector3d(at.x(), at.y(), 1)) - kRim_mm || std::abs(at.x()) < 4) return;
      Half& half = at.x() < 0 ? minus : plus;
      half.sum += at;
      half.cells += 1;
    });
    const double cell = Relief::kCell_mm * Relief::kCell_mm;
    plateau.area_minus_mm2 = minus.cells * cell;
    plateau.area_plus_mm2 = plus.cells * cell;
    if (std::min(plateau.area_minus_mm2, plateau.area_plus_mm2) < kLeastHalf_mm2) return std::nullopt;
    plateau.middle_minus = minus.sum / minus.cells;
    plateau.middle_plus = plus.sum / plus.cells;
    if (round == kRounds - 1) break;
    const Vector2d middle = (plateau.middle_minus + plateau.middle_plus) / 2;
    const Vector2d line = plateau.middle_plus - plateau.middle_minus;
    origin += axes * Vector3d(middle.x(), middle.y(), plane.dot(Vector3d(middle.x(), middle.y(), 1)));
    const Vector3d z = (axes * Vector3d(-plane.x(), -plane.y(), 1)).normalized();
    Vector3d x = axes * Vector3d(line.x(), line.y(), 0);
    x = (x - x.dot(z) * z).normalized();
    axes.col(0) = x;
    axes.col(1) = z.cross(x);
    axes.col(2) = z;
  }
  return plateau;
}

}  // namespace arthronaut::landmarks
