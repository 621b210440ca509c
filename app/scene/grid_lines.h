// The grids that surgeons publish in, as lines: over the bone in 3D and on the lateral view. A grid is four
// by four, its norm an ellipse of one standard deviation about the mean.
#pragma once

#include <optional>
#include <vector>

#include "app/scene/scene_content.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::scene {

// Points in the bone's frame; each line two or more.
struct GridLines {
  std::vector<std::vector<Eigen::Vector3d>> rims, divisions;  // the outline of the grid; what divides it
  std::vector<Eigen::Vector3d> norm;                          // closed
  Eigen::Vector3d norm_center_mm = Eigen::Vector3d::Zero();
};

[[nodiscard]] GridLines grid_lines(const landmarks::FemoralQuadrant& quadrant,
                                   const tunnels::PlanNorms& norms = {});
// In the plane through the plateau's anterior edge.
[[nodiscard]] GridLines grid_lines(const landmarks::TibialGrid& grid, const tunnels::PlanNorms& norms = {});

inline constexpr Color kGridColor{0.80F, 0.47F, 0.65F}, kNormColor{0.94F, 0.89F, 0.26F};
void add_grid(SceneContent& content, const GridLines& lines);

}  // namespace arthronaut::scene
