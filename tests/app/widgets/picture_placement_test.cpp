#include "app/widgets/picture_placement.h"

#include <gtest/gtest.h>

#include "tests/app/scope.h"

namespace arthronaut::widgets {
namespace {

using test::scope;

// The picture as it came: the corner of the shown part stands in the corner of the area, half a pixel aside,
// and scale is the same both ways.
TEST(PicturePlacement, PutsTheRoundViewIntoTheArea) {
  const Rect part = shown_part(scope().boundary, 1920, 1080);
  EXPECT_FLOAT_EQ(part.x, 445);
  EXPECT_FLOAT_EQ(part.width, 1030);
  EXPECT_FLOAT_EQ(part.y, 25);
  const PicturePlacement placement({100, 50, 515, 515}, part);
  const auto corner = placement.on_screen({445, 25});
  ASSERT_TRUE(corner);
  EXPECT_FLOAT_EQ(corner->x, 100.25F);
  EXPECT_FLOAT_EQ(corner->y, 50.25F);
  EXPECT_FLOAT_EQ(placement.on_screen({1445, 25})->x, 600.25F);
  EXPECT_FLOAT_EQ(shown_part({}, 640, 480).height, 480) << "no boundary: all of it";
}

// Undistorted: the optical axis stands in the middle of the square, and a pixel is drawn exactly where the
// shader's table shows it (0.1 px: the table is linear between its places, what is drawn is not).
TEST(PicturePlacement, LiesOnTheUndistortedPicture) {
  const camera::CameraModel camera(scope(), 0.9, 1.3345);
  const camera::UndistortedView view(camera::CameraModel(scope(), 0, 1.3345));
  const Rect area{100, 50, 800, 800};
  const PicturePlacement placement(area, camera, view);
  const auto middle = placement.on_screen(camera.principal_point_px());
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x, 500, 1e-3);
  EXPECT_NEAR(middle->y, 450, 1e-3);
  for (const Eigen::Vector2d& shown :
       {Eigen::Vector2d(0.5, -0.3), Eigen::Vector2d(-0.6, 0.2), Eigen::Vector2d(0.1, 0.7)}) {
    const auto at = placement.on_screen(view.pixel_from_view(camera, shown));
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, 500 + 400 * shown.x(), 0.1);
    EXPECT_NEAR(at->y, 450 + 400 * shown.y(), 0.1);
  }
}

}  // namespace
}  // namespace arthronaut::widgets
