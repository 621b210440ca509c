// The grids that surgeons publish in, as lines: over the bone in 3D and on the lateral view. A grid is four
// by four, a norm an ellipse of one standard deviation about the mean.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/scene/scene_content.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/norms/insertion_norms.h"
#include "planning/tunnels/plan_norms.h"

namespace arthronaut::scene {

// Points in the bone's frame; each line two or more.
struct GridLines {
  std::vector<std::vector<Eigen::Vector3d>> rims, divisions;  // the outline of the grid; what divides it
};
[[nodiscard]] GridLines grid_lines(const landmarks::FemoralQuadrant& quadrant);
// In the plane through the plateau's anterior edge.
[[nodiscard]] GridLines grid_lines(const landmarks::TibialGrid& grid);

// What a tunnel of that graft is held against (tunnels/plan_checks.h), in the grid's plane.
struct NormEllipse {
  norms::Bundle bundle = norms::Bundle::Whole;
  std::vector<Eigen::Vector3d> outline_mm;  // closed
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  // "AM bundle: 24.2 ± 4.0 % deep to shallow, 21.6 ± 5.2 % high to low (review (Arthroscopy 2016))"
  std::string words;
};
[[nodiscard]] NormEllipse norm_ellipse(const landmarks::FemoralQuadrant& quadrant, norms::Bundle bundle,
                                       const tunnels::PlanNorms& norms = {});
[[nodiscard]] NormEllipse norm_ellipse(const landmarks::TibialGrid& grid, norms::Bundle bundle,
                                       const tunnels::PlanNorms& norms = {});

inline constexpr Color kGridColor{0.80F, 0.47F, 0.65F}, kNormColor{0.94F, 0.89F, 0.26F};
void add_grid(SceneContent& content, const GridLines& lines, std::span<const NormEllipse> norms);

}  // namespace arthronaut::scene
