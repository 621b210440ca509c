#include "app/scene/grid_lines.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace arthronaut::scene {

namespace {

// at: takes percentages along and across to a point.
template <typename PointAt>
GridLines lines_of(const PointAt& at, const tunnels::NormRange& along, const tunnels::NormRange& across) {
  GridLines lines;
  constexpr int kParts = 4;
  for (int i = 0; i <= kParts; ++i) {
    const double percent = 100.0 * i / kParts;
    auto& group = i == 0 || i == kParts ? lines.rims : lines.divisions;
    group.push_back({at(percent, 0.0), at(percent, 100.0)});
    group.push_back({at(0.0, percent), at(100.0, percent)});
  }
  constexpr int kPoints = 48;
  for (int i = 0; i < kPoints; ++i) {
    const double turn = 2 * std::numbers::pi * i / kPoints;
    lines.norm.push_back(
        at(along.center + along.radius * std::cos(turn), across.center + across.radius * std::sin(turn)));
  }
  lines.norm_center_mm = at(along.center, across.center);
  return lines;
}

}  // namespace

GridLines grid_lines(const landmarks::FemoralQuadrant& quadrant, const tunnels::PlanNorms& norms) {
  return lines_of(
      [&](double deep, double high) {
        return quadrant.point_at({deep, high});
      },
      norms.femur_deep_shallow_percent, norms.femur_high_low_percent);
}

GridLines grid_lines(const landmarks::TibialGrid& grid, const tunnels::PlanNorms& norms) {
  return lines_of(
      [&](double back, double lateral) {
        return grid.point_at({back, lateral});
      },
      norms.tibia_anterior_posterior_percent, norms.tibia_medial_lateral_percent);
}

void add_grid(SceneContent& content, const GridLines& lines) {
  for (const auto& line : lines.rims) content.lines.push_back({line, 0.6, false, kGridColor, true});
  for (const auto& line : lines.divisions) content.lines.push_back({line, 0.3, false, kGridColor, true});
  content.lines.push_back({lines.norm, 0.5, true, kNormColor, true});
}

}  // namespace arthronaut::scene
