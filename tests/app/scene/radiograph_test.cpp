#include "app/scene/radiograph.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::scene {
namespace {

// Through a block at right angles: its depth everywhere inside its outline, nothing outside.
TEST(Radiograph, OfABlockIsItsDepth) {
  SlicePlane plane;  // seen from the feet: right is +x, down +y, the beam goes along +z
  plane.mm_per_px = 1;
  const Eigen::Vector2i size(61, 61);
  const auto thickness = thickness_along(test::box({10.4, 20.4, 7}, {0, 0, 3}), plane, size);
  for (int y = 0; y < 61; ++y)
    for (int x = 0; x < 61; ++x) {
      const bool is_inside = std::abs(x - 30) <= 10 && std::abs(y - 30) <= 20;
      ASSERT_NEAR(thickness[static_cast<std::size_t>(y) * 61 + static_cast<std::size_t>(x)],
                  is_inside ? 14 : 0, 1e-4)
          << x << ", " << y;
    }
}

// Through a ball from an oblique side: the chord of a sphere. The mesh is a polyhedron inside of it.
TEST(Radiograph, OfABallIsItsChord) {
  SlicePlane plane;
  plane.right = Eigen::Vector3d(1, 2, 0.5).normalized();
  plane.down = plane.right.unitOrthogonal();
  plane.mm_per_px = 0.5;
  const Eigen::Vector2i size(101, 101);
  const auto thickness = thickness_along(test::ellipsoid({20, 20, 20}, 5), plane, size);
  for (int y = 15; y <= 85; ++y)
    for (int x = 15; x <= 85; ++x) {
      const double away = 0.5 * std::hypot(x - 50, y - 50);
      if (away > 17) continue;  // at the rim a facet's fall is steep
      ASSERT_NEAR(thickness[static_cast<std::size_t>(y) * 101 + static_cast<std::size_t>(x)],
                  2 * std::sqrt(400 - away * away), 0.4)
          << x << ", " << y;
    }
}

TEST(Radiograph, MoreBoneIsBrighter) {
  const auto grey = radiograph_from({0, 10, 60, 500}, 0.02);
  EXPECT_EQ(grey[0], 0);
  EXPECT_NEAR(grey[1], 255 * (1 - std::exp(-0.2)), 0.51);
  EXPECT_GT(grey[2], grey[1]);
  EXPECT_EQ(grey[3], 255);
}

}  // namespace
}  // namespace arthronaut::scene
