#include "app/scene/grid_lines.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::scene {
namespace {

using bones::BoneKind;

const cases::Case& knee() {
  static const cases::Case made = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  return made;
}

// What is drawn is where the grid says it is: the points of the norm's ellipse have the percentages of an
// ellipse, the corners those of corners.
TEST(GridLines, OfTheFemurLieAtTheirPercentages) {
  const auto quadrant = landmarks::femoral_quadrant(knee().bones.at(BoneKind::Femur).mesh,
                                                    knee().landmarks.at(BoneKind::Femur), knee().side);
  ASSERT_TRUE(quadrant);
  const tunnels::PlanNorms norms;
  const GridLines lines = grid_lines(*quadrant, norms);
  EXPECT_EQ(lines.rims.size(), 4U);
  EXPECT_EQ(lines.divisions.size(), 6U);
  const auto center = quadrant->percent_of(lines.norm_center_mm);
  EXPECT_NEAR(center.deep_shallow, norms.femur_deep_shallow_percent.center, 1e-9);
  EXPECT_NEAR(center.high_low, norms.femur_high_low_percent.center, 1e-9);
  for (const Eigen::Vector3d& point : lines.norm) {
    const auto percent = quadrant->percent_of(point);
    EXPECT_NEAR(
        std::hypot((percent.deep_shallow - center.deep_shallow) / norms.femur_deep_shallow_percent.radius,
                   (percent.high_low - center.high_low) / norms.femur_high_low_percent.radius),
        1, 1e-9);
  }
}

TEST(GridLines, OfTheTibiaLieAtTheirPercentages) {
  const auto grid = landmarks::tibial_grid(knee().landmarks.at(BoneKind::Tibia));
  ASSERT_TRUE(grid);
  for (const landmarks::TibialGrid::Percent wanted :
       {landmarks::TibialGrid::Percent{0, 0}, {41.5, 46.7}, {100, 100}}) {
    const auto percent = grid->percent_of(grid->point_at(wanted));
    EXPECT_NEAR(percent.anterior_posterior, wanted.anterior_posterior, 1e-9);
    EXPECT_NEAR(percent.medial_lateral, wanted.medial_lateral, 1e-9);
  }
  EXPECT_EQ(grid_lines(*grid).norm.size(), 48U);
}

}  // namespace
}  // namespace arthronaut::scene
