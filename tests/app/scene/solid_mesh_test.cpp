#include "app/scene/solid_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace arthronaut::scene {
namespace {

double volume_of(const SolidMesh& mesh) {
  double six_times = 0;
  const auto point = [&](std::int32_t i) {
    return mesh.points_mm[static_cast<std::size_t>(i)].cast<double>().eval();
  };
  for (const auto& t : mesh.triangles) six_times += point(t[0]).dot(point(t[1]).cross(point(t[2])));
  return six_times / 6;
}

// A closed solid that faces outwards has the volume of its shape; a polygon of 24 sides lacks about 1 % of a
// circle.
TEST(SolidMesh, RodIsClosedAndFacesOutwards) {
  SolidMesh mesh;
  mesh.add(RodItem{{1, 2, 3}, {4, 6, 15}, 9, 9, kPlanColor, false});
  const double exact = std::numbers::pi * 4.5 * 4.5 * 13;
  EXPECT_NEAR(volume_of(mesh), exact, 0.02 * exact);
}

// The same for a cone and a ball (coarser: 14 x 8 faces).
TEST(SolidMesh, ConeAndBallAreClosedAndFaceOutwards) {
  SolidMesh cone, ball;
  cone.add(RodItem{{0, 0, 0}, {0, 0, 7}, 4, 0, kGuideColor, false});
  EXPECT_NEAR(volume_of(cone), std::numbers::pi * 4 * 7 / 3, 0.02 * std::numbers::pi * 4 * 7 / 3);
  ball.add(BallItem{{5, 5, 5}, 10, kCurveColor, false});
  EXPECT_NEAR(volume_of(ball), std::numbers::pi * 1000 / 6, 0.12 * std::numbers::pi * 1000 / 6);
}

// Degenerate items leave nothing behind: no triangle with a number that is not finite.
TEST(SolidMesh, DegenerateItemsAreLeftOut) {
  SolidMesh mesh;
  mesh.add(RodItem{{1, 1, 1}, {1, 1, 1}, 2, 2, kPlanColor, false});
  mesh.add(LineItem{{{0, 0, 0}}, 1, false, kPlanColor, false});
  mesh.add(LineItem{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 1, true, kPlanColor, false});
  for (const auto& point : mesh.points_mm) EXPECT_TRUE(point.allFinite());
}

}  // namespace
}  // namespace arthronaut::scene
