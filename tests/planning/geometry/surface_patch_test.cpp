#include "planning/geometry/surface_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::geometry {
namespace {

using Eigen::Vector3d;

// A circle of the ball, as far from its pole as `polar_rad`, on the mesh.
std::vector<Vector3d> circle_on(const Surface& ball, double radius_mm, double polar_rad) {
  std::vector<Vector3d> outline;
  for (int i = 0; i < 180; ++i) {
    const double about = 2 * kPi * i / 180;
    outline.push_back(
        ball.closest_point(radius_mm * Vector3d(std::sin(polar_rad) * std::cos(about),
                                                std::sin(polar_rad) * std::sin(about), std::cos(polar_rad)))
            .point_mm);
  }
  return outline;
}

// Whole triangles and parts of them; the line may run either way round.
TEST(SurfacePatch, OnAPlaneIsTheOutlinesArea) {
  const Surface box(test::box({30, 30, 30}));
  std::vector<Vector3d> outline{{-7, -4, 30}, {8, -4, 30}, {8, 6, 30}, {-7, 6, 30}};
  EXPECT_NEAR(patch_within(box, outline).area_mm2, 150, 1e-9);
  std::ranges::reverse(outline);
  EXPECT_NEAR(patch_within(box, outline).area_mm2, 150, 1e-9);
  outline.insert(outline.begin() + 3, Vector3d(0.5, 1, 30));  // a dent of 15 by 5 mm
  EXPECT_NEAR(patch_within(box, outline).area_mm2, 150 - 0.5 * 15 * 5, 1e-9);
}

// Archimedes: a cap is 2 pi r^2 (1 - cos theta), more than the disc that one sees of it.
TEST(SurfacePatch, OnABallIsArchimedesCap) {
  constexpr double kRadius_mm = 20;
  const Surface ball(test::ellipsoid(Vector3d::Constant(kRadius_mm), 5));
  for (const double polar_deg : {10.0, 30.0, 60.0}) {
    const double polar_rad = rad_from_deg(polar_deg);
    const double cap_mm2 = 2 * kPi * kRadius_mm * kRadius_mm * (1 - std::cos(polar_rad));
    const double found_mm2 = patch_within(ball, circle_on(ball, kRadius_mm, polar_rad)).area_mm2;
    // The mesh itself lies within the ball by about a thousandth.
    EXPECT_NEAR(found_mm2, cap_mm2, 0.003 * cap_mm2) << polar_deg << " deg";
  }
}

// However it lies.
TEST(SurfacePatch, AreaDoesNotDependOnWhereTheBoneLies) {
  const auto bone = test::ellipsoid({30, 22, 15}, 4);
  std::vector<Vector3d> outline;
  {
    const Surface surface(bone);
    for (int i = 0; i < 48; ++i) {
      const double about = 2 * kPi * i / 48;
      outline.push_back(surface.closest_point({8 * std::cos(about), 22, 5 * std::sin(about)}).point_mm);
    }
  }
  const double before_mm2 = patch_within(Surface(bone), outline).area_mm2;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 3; ++trial) {
    const Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    const RigidTransform moved{turn.normalized(), {normal(random), 10 * normal(random), 40}};
    auto there = bone;
    auto line = outline;
    for (Vector3d& p : there.vertices_mm) p = moved * p;
    for (Vector3d& p : line) p = moved * p;
    EXPECT_NEAR(patch_within(Surface(there), line).area_mm2, before_mm2, 1e-6);
  }
}

// A thin plate has a far side that faces the same way as nothing of this one.
TEST(SurfacePatch, TakesNothingFromBehind) {
  const Surface plate(test::box({30, 30, 1}));
  EXPECT_NEAR(patch_within(plate, {{-5, -5, 1}, {5, -5, 1}, {5, 5, 1}, {-5, 5, 1}}).area_mm2, 100, 1e-9);
  EXPECT_EQ(patch_within(plate, {{-5, -5, 1}, {5, -5, 1}}).area_mm2, 0);
  EXPECT_EQ(patch_within(plate, {{-5, -5, 1}, {5, -5, 1}, {0, -5, 1}}).area_mm2, 0);
}

}  // namespace
}  // namespace arthronaut::geometry
