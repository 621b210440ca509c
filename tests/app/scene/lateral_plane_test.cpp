#include "app/scene/lateral_plane.h"

#include <gtest/gtest.h>

namespace arthronaut::scene {
namespace {

// A grid that hangs below the bone, as the lowest row of a turned one does: all of it is in the picture, and
// so is the bone.
TEST(LateralPlane, HoldsTheBoneAndItsGrid) {
  landmarks::FemoralQuadrant quadrant;
  quadrant.corner_mm = {0, 20, -10};
  quadrant.shallow = Eigen::Vector3d(0, -1, -1).normalized();
  quadrant.low = Eigen::Vector3d(0, 1, -1).normalized();
  quadrant.depth_mm = 50;
  quadrant.height_mm = 30;
  const geometry::Bounds bone{{-40, -30, -40}, {40, 35, 40}};
  const auto axes = landmarks::scanner_axes(bones::Side::Right);
  for (const Eigen::Vector2i& size : {Eigen::Vector2i(800, 400), Eigen::Vector2i(400, 800)}) {
    const SlicePlane plane = lateral_plane(axes, quadrant, bone, size);
    const auto is_in_picture = [&](const Eigen::Vector3d& point) {
      const Eigen::Vector2d pixel = plane.pixel_of(point, size);
      return pixel.minCoeff() > 0 && pixel.x() < size.x() && pixel.y() < size.y();
    };
    for (const double along : {0.0, 100.0})
      for (const double across : {0.0, 100.0}) EXPECT_TRUE(is_in_picture(quadrant.point_at({along, across})));
    EXPECT_TRUE(is_in_picture(bone.min_mm));
    EXPECT_TRUE(is_in_picture(bone.max_mm));
  }
}

}  // namespace
}  // namespace arthronaut::scene
