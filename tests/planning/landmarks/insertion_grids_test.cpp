#include "planning/landmarks/insertion_grids.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::landmarks {
namespace {

using Eigen::Vector3d;

// A box as the femur: Blumensaat's line along its middle, so that the lower half is the condyle: 60 mm deep,
// 20 mm high.
Landmarks roof_of_a_box() {
  return {{"blumensaat_anterior", {0, -20, 0}}, {"blumensaat_posterior", {0, 10, 0}}};
}

TEST(FemoralQuadrant, ReadsPercentagesOffABox) {
  const auto quadrant = femoral_quadrant(test::box({40, 30, 20}), roof_of_a_box(), bones::Side::Right);
  // The box has corners only below the line at z = -20: the rectangle spans them.
  ASSERT_TRUE(quadrant);
  EXPECT_NEAR(quadrant->depth_mm, 60, 1e-12);
  EXPECT_NEAR(quadrant->height_mm, 20, 1e-12);
  const auto percent = quadrant->percent_of({-17, 30 - 0.28 * 60, -0.35 * 20});
  EXPECT_NEAR(percent.deep_shallow, 28, 1e-9);
  EXPECT_NEAR(percent.high_low, 35, 1e-9);
}

TEST(FemoralQuadrant, FindsThePointOfAPercentage) {
  const auto quadrant = femoral_quadrant(test::box({40, 30, 20}), roof_of_a_box(), bones::Side::Left);
  ASSERT_TRUE(quadrant);
  for (const double a : {0.0, 28.0, 100.0}) {
    for (const double b : {0.0, 35.0, 100.0}) {
      const auto back = quadrant->percent_of(quadrant->point_at({.deep_shallow = a, .high_low = b}));
      EXPECT_NEAR(back.deep_shallow, a, 1e-9);
      EXPECT_NEAR(back.high_low, b, 1e-9);
    }
  }
}

// Percentages belong to the bone, not to how it lies: a leg flexed by 30 degrees reads the same. The
// condyles' line is what the view is along, so it has to be known.
TEST(FemoralQuadrant, TurnsWithTheBone) {
  const geometry::RigidTransform flexed{Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitX())),
                                        {5, -7, 9}};
  auto mesh = test::ellipsoid({40, 30, 20}, 3);
  auto marks = roof_of_a_box();
  marks["lateral_condyle_posterior"] = {-20, 25, -5};
  marks["medial_condyle_posterior"] = {20, 25, -5};
  const Vector3d entry(-9, 12, -6);
  const auto before = femoral_quadrant(mesh, marks, bones::Side::Right)->percent_of(entry);
  for (auto& v : mesh.vertices_mm) v = flexed * v;
  for (auto& [name, p] : marks) p = flexed * p;
  const auto after = femoral_quadrant(mesh, marks, bones::Side::Right)->percent_of(flexed * entry);
  EXPECT_NEAR(after.deep_shallow, before.deep_shallow, 1e-9);
  EXPECT_NEAR(after.high_low, before.high_low, 1e-9);
}

// No landmark, no number.
TEST(FemoralQuadrant, NeedsBlumensaatsLine) {
  const auto mesh = test::box({40, 30, 20});
  EXPECT_FALSE(femoral_quadrant(mesh, {}, bones::Side::Right));
  EXPECT_FALSE(femoral_quadrant(
      mesh, {{"blumensaat_anterior", {0, 0, 0}}, {"blumensaat_posterior", {0, 3, 0}}}, bones::Side::Right));
}

TEST(TibialGrid, ReadsSharesFromAbove) {
  const Landmarks marks{{"plateau_anterior", {2, -25, 3}},
                        {"plateau_posterior", {9, 25, -4}},
                        {"plateau_medial", {38, 1, 0}},
                        {"plateau_lateral", {-38, 1, 2}}};
  const auto grid = tibial_grid(marks);
  ASSERT_TRUE(grid);
  // Heights along the view do not enter; the view leans 8 degrees against what is at right angles to the
  // edges.
  const auto percent =
      grid->percent_of(grid->point_at({.anterior_posterior = 41, .medial_lateral = 47}) + 17 * grid->up);
  EXPECT_NEAR(percent.anterior_posterior, 41, 1e-9);
  EXPECT_NEAR(percent.medial_lateral, 47, 1e-9);
  const Vector3d across = (marks.at("plateau_lateral") - marks.at("plateau_medial")).normalized();
  const Vector3d along = marks.at("plateau_posterior") - marks.at("plateau_anterior");
  const Vector3d normal = across.cross(along - along.dot(across) * across).normalized();
  EXPECT_NEAR(std::abs(normal.dot(grid->up)), std::cos(geometry::rad_from_deg(8)), 1e-9);
  EXPECT_NEAR(grid->percent_of(marks.at("plateau_posterior")).anterior_posterior, 100, 1e-9);
  EXPECT_NEAR(grid->percent_of(marks.at("plateau_lateral")).medial_lateral, 100, 1e-9);
  EXPECT_FALSE(tibial_grid({}));
}

}  // namespace
}  // namespace arthronaut::landmarks
