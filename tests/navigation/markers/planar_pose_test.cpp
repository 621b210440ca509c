#include "navigation/markers/planar_pose.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

Corners seen_corners(const camera::CameraModel& camera, const RigidTransform& pose, double size_mm) {
  Corners corners;
  const auto corners_mm = square_corners_mm(size_mm);
  for (int i = 0; i < 4; ++i) corners[i] = camera.project(pose * corners_mm[i]).value();
  return corners;
}

double angle_deg(const RigidTransform& a, const RigidTransform& b) {
  return geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation));
}

class PlanarPose : public ::testing::Test {
 protected:
  RigidTransform random_pose() {
    std::uniform_real_distribution<double> side(-6, 6), depth(14, 40), tilt(-45, 45), turn(-180, 180);
    const double x = side(random_), y = side(random_), z = depth(random_), a = tilt(random_),
                 b = tilt(random_);
    return facing_pose(x, y, z, a, b, turn(random_));
  }
  std::mt19937 random_{5};
  camera::CameraModel camera_ = small_scope();
};

// One of the two closed-form poses of an exact homography is the truth, without any refinement.
TEST_F(PlanarPose, HoldsTheTruthAmongTheTwoClosedFormSolutions) {
  for (int i = 0; i < 200; ++i) {
    const RigidTransform truth = random_pose();
    Corners tangent;
    const auto corners_mm = square_corners_mm(4);
    for (int k = 0; k < 4; ++k) tangent[k] = (truth * corners_mm[k]).hnormalized();
    const auto homography = square_homography(tangent, 4);
    ASSERT_TRUE(homography);
    const auto poses = poses_from_homography(*homography);
    EXPECT_LT(std::min(angle_deg(poses[0], truth), angle_deg(poses[1], truth)), 1e-5);
    EXPECT_LT((poses[0].translation_mm - truth.translation_mm).norm(), 1e-6);
  }
}

// Corners seen through the wet, turned, distorted lens give the pose back.
TEST_F(PlanarPose, IsExactOnDistortedPixels) {
  for (int i = 0; i < 200; ++i) {
    const RigidTransform truth = random_pose();
    const auto poses = solve_square(camera_, seen_corners(camera_, truth, 4), 4);
    ASSERT_TRUE(poses);
    EXPECT_LT(angle_deg(poses->best.camera_from_marker, truth), 1e-4);
    EXPECT_LT((poses->best.camera_from_marker.translation_mm - truth.translation_mm).norm(), 1e-5);
    EXPECT_LT(poses->best.rms_px, 1e-5);
    if (poses->other) {
      EXPECT_GT(poses->other->rms_px, poses->best.rms_px);
      EXPECT_GT(poses->ambiguity_ratio, 1);
    }
  }
}

// The covariance is that of repeated noisy measurements: mean squared normalised error 1, within 4 sigma of
// 400 samples of 6 degrees of freedom (0.12), plus what linearisation costs.
TEST_F(PlanarPose, PredictsItsCovariance) {
  const RigidTransform truth = facing_pose(2, -1, 20, 25, -18, 40);
  const Corners exact = seen_corners(camera_, truth, 4);
  std::normal_distribution<double> noise(0, 0.1);
  double sum = 0;
  for (int i = 0; i < 400; ++i) {
    Corners noisy = exact;
    for (auto& corner : noisy) {
      corner.x() += noise(random_);
      corner.y() += noise(random_);
    }
    const auto poses = solve_square(camera_, noisy, 4);
    ASSERT_TRUE(poses);
    const geometry::Vector6d error = geometry::log(poses->best.camera_from_marker.inverse() * truth);
    sum += error.dot(square_covariance(poses->best, 0.1).inverse() * error) / 6;
  }
  EXPECT_NEAR(sum / 400, 1, 0.2);
}

// Far away and nearly head-on the two poses explain noisy corners alike; near and tilted they do not.
TEST_F(PlanarPose, TellsAmbiguityByTheRatio) {
  Corners far = seen_corners(camera_, facing_pose(0, 0, 90, 8, 0, 0), 4);
  far[0].x() += 0.3;
  far[2].y() -= 0.3;
  const auto ambiguous = solve_square(camera_, far, 4);
  ASSERT_TRUE(ambiguous && ambiguous->other);
  EXPECT_LT(ambiguous->ambiguity_ratio, 2);
  Corners near = seen_corners(camera_, facing_pose(0, 0, 18, 35, 0, 0), 4);
  near[0].x() += 0.05;
  const auto clear = solve_square(camera_, near, 4);
  ASSERT_TRUE(clear);
  EXPECT_GT(clear->ambiguity_ratio, 10);
}

// Three corners in line, or all in one place, are no square.
TEST_F(PlanarPose, RefusesCornersInLine) {
  EXPECT_FALSE(square_homography({Eigen::Vector2d(0, 0), {1, 0}, {2, 0}, {3, 0}}, 4).has_value());
  EXPECT_FALSE(square_homography({Eigen::Vector2d(1, 1), {1, 1}, {1, 1}, {1, 1}}, 4).has_value());
}

}  // namespace
}  // namespace arthronaut::markers
