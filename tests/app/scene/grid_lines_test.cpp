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
  const GridLines lines = grid_lines(*quadrant);
  EXPECT_EQ(lines.rims.size(), 4U);
  EXPECT_EQ(lines.divisions.size(), 6U);
  // Of the whole ligament and of its bundles, as the studies have them (docs/plan_checks.md names them).
  struct Study {
    norms::Bundle bundle;
    double deep, deep_sd, high, high_sd;
    std::string words;
  };
  for (const Study& study :
       {Study{norms::Bundle::Whole, 28.4, 5.1, 35.7, 6.9,
              "Ligament: 28.4 ± 5.1 % deep to shallow, 35.7 ± 6.9 %"},
        Study{norms::Bundle::Anteromedial, 24.2, 4.0, 21.6, 5.2, "AM bundle: 24.2 ± 4.0 % deep"},
        Study{norms::Bundle::Posterolateral, 32.8, 4.7, 46.7, 4.9, "PL bundle: 32.8 ± 4.7 % deep"}}) {
    const NormEllipse norm = norm_ellipse(*quadrant, study.bundle);
    EXPECT_EQ(norm.words.rfind(study.words, 0), 0U) << norm.words;
    const auto center = quadrant->percent_of(norm.center_mm);
    EXPECT_NEAR(center.deep_shallow, study.deep, 1e-9);
    EXPECT_NEAR(center.high_low, study.high, 1e-9);
    EXPECT_EQ(norm.outline_mm.size(), 48U);
    for (const Eigen::Vector3d& point : norm.outline_mm) {
      const auto percent = quadrant->percent_of(point);
      EXPECT_NEAR(std::hypot((percent.deep_shallow - study.deep) / study.deep_sd,
                             (percent.high_low - study.high) / study.high_sd),
                  1, 1e-9);
    }
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
  EXPECT_EQ(grid_lines(*grid).rims.size(), 4U);
  const NormEllipse posterolateral = norm_ellipse(*grid, norms::Bundle::Posterolateral);
  EXPECT_NEAR(grid->percent_of(posterolateral.center_mm).anterior_posterior, 48.9, 1e-9);
  EXPECT_NE(posterolateral.words.find("customary"), std::string::npos) << posterolateral.words;
}

}  // namespace
}  // namespace arthronaut::scene
