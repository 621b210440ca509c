#include "planning/landmarks/insertion_grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"
#include "planning/landmarks/grid_landmarks.h"
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

// Each landmark that is named moves the grid of a box, whose corners give it no condyles; no other one does.
TEST(FemoralQuadrant, NamesWhatItFollowsFrom) {
  Landmarks marks = roof_of_a_box();
  marks["lateral_epicondyle"] = {-30, 0, -5};
  for (const auto& [name, at] : Landmarks{{"lateral_condyle_center", {-20, 20, -5}},
                                          {"medial_condyle_center", {20, 21, -5}},
                                          {"lateral_condyle_posterior", {-20, 25, -5}},
                                          {"medial_condyle_posterior", {20, 25, -6}},
                                          {"lateral_condyle_deep", {-20, 28, -4}},
                                          {"lateral_condyle_shallow", {-20, -27, -4}},
                                          {"lateral_condyle_low", {-20, 3, -19}}})
    marks[name] = at;
  const auto box = test::box({40, 30, 20});
  const auto percent_with = [&](const Landmarks& with) {
    const auto quadrant = femoral_quadrant(box, with, bones::Side::Right);
    const auto percent = quadrant->percent_of({-17, 5, -7});
    return Eigen::Vector2d(percent.deep_shallow, percent.high_low);
  };
  const auto named = grid_landmarks(bones::BoneKind::Femur, marks);
  for (const auto& [name, at] : marks) {
    Landmarks moved = marks;
    moved[name] += Vector3d(3, 2, -4);
    const bool moves_grid = (percent_with(moved) - percent_with(marks)).norm() > 1e-6;
    EXPECT_EQ(moves_grid, std::ranges::find(named, name) != named.end()) << name;
  }
  marks.erase("lateral_condyle_low");
  EXPECT_EQ(grid_landmarks(bones::BoneKind::Femur, marks).size(), 4U) << "the outline tells the extents";
}

// One vertex that a segmentation drew out to a needle is no condyle: without landmarks of its extents the
// rectangle is the one of the same bone without it, on every side.
TEST(FemoralQuadrant, ANeedleIsNoOutline) {
  const auto bone = test::ellipsoid({40, 30, 20}, 5);
  const auto clean = femoral_quadrant(bone, roof_of_a_box(), bones::Side::Right);
  ASSERT_TRUE(clean);
  for (const Vector3d& way : {clean->low, clean->shallow, Vector3d(-clean->shallow)}) {
    auto drawn_out = bone;
    // Beside the middle, where the bone is on the lateral side of the notch.
    const Vector3d towards = 15 * clean->lateral + 30 * way;
    auto& tip = *std::ranges::max_element(drawn_out.vertices_mm, {}, [&](const Vector3d& v) {
      return v.normalized().dot(towards.normalized());
    });
    tip += 6 * way;
    const auto found = femoral_quadrant(drawn_out, roof_of_a_box(), bones::Side::Right);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->height_mm, clean->height_mm, 0.05);
    EXPECT_NEAR(found->depth_mm, clean->depth_mm, 0.05);
    EXPECT_LT((found->corner_mm - clean->corner_mm).norm(), 0.05);
  }
}

// Where Blumensaat's line cuts the outline off while it still widens, the edge is at the cut, and not further
// in.
TEST(FemoralQuadrant, ACutOutlineReachesToTheCut) {
  const auto bone = test::ellipsoid({40, 30, 20}, 5);
  const Landmarks marks{{"blumensaat_anterior", {0, -20, -8}}, {"blumensaat_posterior", {0, 10, -8}}};
  const auto quadrant = femoral_quadrant(bone, marks, bones::Side::Right);
  ASSERT_TRUE(quadrant);
  double deep = 0, shallow = 0;
  for (const Vector3d& v : bone.vertices_mm) {
    if (v.dot(quadrant->lateral) < 1e-6 || v.z() > -8) continue;
    deep = std::max(deep, -v.dot(quadrant->shallow));
    shallow = std::max(shallow, v.dot(quadrant->shallow));
  }
  EXPECT_NEAR(quadrant->depth_mm, deep + shallow, 0.05);
  EXPECT_NEAR(quadrant->height_mm, 12, 0.05);
}

// Two landmarks that the surgeon placed are not "proposed by the program": what is missing is said to be
// missing.
TEST(GridLandmarks, MissingOnesAreNotCalledProposed) {
  Landmarks marks = roof_of_a_box();
  const std::string missing = grid_doubt(bones::BoneKind::Femur, marks, {});
  EXPECT_EQ(
      missing,
      "landmarks missing: lateral_condyle_posterior, medial_condyle_posterior, so that it is seen along "
      "the scanner's axis");
  EXPECT_FALSE(is_grid_confirmed(bones::BoneKind::Femur, marks, {}));
  marks["lateral_condyle_center"] = {-20, 20, -5};
  marks["medial_condyle_center"] = {20, 21, -5};
  EXPECT_EQ(grid_doubt(bones::BoneKind::Femur, marks, {}), "");
  LandmarkStates states{{"medial_condyle_center", LandmarkState::Proposed}};
  EXPECT_EQ(grid_doubt(bones::BoneKind::Femur, marks, states),
            "landmarks proposed from the bone's shape and not confirmed: medial_condyle_center");
  for (const auto& [name, at] : marks) states[name] = LandmarkState::Proposed;
  EXPECT_EQ(grid_doubt(bones::BoneKind::Femur, marks, states),
            "landmarks proposed from the bone's shape, confirmed by nobody");
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
