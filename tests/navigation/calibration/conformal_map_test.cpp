#include "navigation/calibration/conformal_map.h"

#include <gtest/gtest.h>

#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

struct Pairs {
  std::vector<Eigen::Vector2d> pixels, board_mm;
};

Pairs exact_pairs(const BoardView& view) {
  std::mt19937 random(1);
  Pairs pairs;
  for (const BoardCorner& corner : picture_of(true_scope(), view, 2, 0, 0, random).board.corners) {
    pairs.pixels.push_back(corner.pixel);
    pairs.board_mm.push_back(2.0 * corner.lattice.cast<double>());
  }
  return pairs;
}

// Without noise one tilted picture gives principal point, distortion, focal length and pose in closed form.
TEST(ConformalMap, IsExactOnExactCorners) {
  const BoardView view{board_pose(20, 30, 40, 10), 0};
  const Pairs pairs = exact_pairs(view);
  const auto map = fit_conformal_map(pairs.pixels, pairs.board_mm);
  ASSERT_TRUE(map);
  const auto camera = camera_of(*map);
  ASSERT_TRUE(camera);
  const camera::Calibration truth = true_scope();
  EXPECT_NEAR((camera->principal_point_px - truth.principal_point_px).norm(), 0, 1e-5);
  const auto focal = focal_from_homographies(std::vector{camera->homography});
  ASSERT_TRUE(focal);
  EXPECT_NEAR(*focal, truth.focal_px, 1e-4);
  EXPECT_NEAR(camera->lambda_px * *focal * *focal, truth.distortion_xi, 1e-6);
  const geometry::RigidTransform pose = pose_from_homography(camera->homography, *focal);
  EXPECT_NEAR((pose.translation_mm - view.camera_from_board.translation_mm).norm(), 0, 1e-5);
  EXPECT_NEAR(pose.rotation.angularDistance(view.camera_from_board.rotation), 0, 1e-6);
}

// The map and its inverse undo each other.
TEST(ConformalMap, FindsThePixelOfAPlanePoint) {
  const Pairs pairs = exact_pairs({board_pose(20, 30, 40, 10), 50});
  const auto map = fit_conformal_map(pairs.pixels, pairs.board_mm);
  ASSERT_TRUE(map);
  for (std::size_t k = 0; k < pairs.pixels.size(); k += 7) {
    const auto pixel = map->pixel_from_plane(pairs.board_mm[k], pairs.pixels[k] + Eigen::Vector2d(15, -10));
    ASSERT_TRUE(pixel);
    EXPECT_NEAR((*pixel - pairs.pixels[k]).norm(), 0, 1e-6);
  }
}

// A board that faces the lens holds no focal length.
TEST(ConformalMap, HasNoFocalLengthFromABoardThatFacesTheLens) {
  Eigen::Matrix3d facing = Eigen::Vector3d(30, 30, 1).asDiagonal();
  EXPECT_FALSE(focal_from_homographies(std::vector{facing}));
}

}  // namespace
}  // namespace arthronaut::calibration
