#include "navigation/guidance/error_budget.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <random>

namespace arthronaut::guidance {
namespace {

using geometry::RigidTransform;

camera::Calibration scope() {
  camera::Calibration c;
  c.image_size_px = {1920, 1080};
  c.focal_px = 580;
  c.principal_point_px = {964, 534};
  c.distortion_xi = -0.28;
  c.rotation_center_px = {957, 542};
  c.boundary = {{962, 537}, 522};
  return c;
}

camera::Calibration off_by(camera::Calibration c, const Eigen::Matrix<double, 6, 1>& error) {
  c.focal_px += error[0];
  c.distortion_xi += error[1];
  c.principal_point_px += error.segment<2>(2);
  c.rotation_center_px += error.segment<2>(4);
  return c;
}

std::array<Eigen::Vector3d, 4> corners(double size) {
  return {Eigen::Vector3d(-size / 2, size / 2, 0), Eigen::Vector3d(size / 2, size / 2, 0),
          Eigen::Vector3d(size / 2, -size / 2, 0), Eigen::Vector3d(-size / 2, -size / 2, 0)};
}

// The pose whose corners lie where those of `truth` are seen through the true camera.
RigidTransform pose_through(const camera::CameraModel& true_camera, const camera::CameraModel& taken,
                            const RigidTransform& truth, double size) {
  RigidTransform pose = truth;
  for (int round = 0; round < 12; ++round) {
    geometry::Matrix6d normal = geometry::Matrix6d::Zero();
    geometry::Vector6d right = geometry::Vector6d::Zero();
    for (const Eigen::Vector3d& corner : corners(size)) {
      Eigen::Matrix<double, 2, 3> d_pixel;
      const Eigen::Vector2d seen = *true_camera.project(truth * corner);
      const Eigen::Vector2d miss = seen - *taken.project(pose * corner, d_pixel);
      Eigen::Matrix<double, 3, 6> move;
      move << pose.matrix(), -pose.matrix() * geometry::cross_matrix(corner);
      const Eigen::Matrix<double, 2, 6> jacobian = d_pixel * move;
      normal += jacobian.transpose() * jacobian;
      right += jacobian.transpose() * miss;
    }
    pose = pose * geometry::exp(normal.ldlt().solve(right));
  }
  return pose;
}

// Each error of the camera, small, against the pose that is solved anew through the camera that has it; with
// the lens turned and in saline, also where the principal point lies on the centre of rotation and does not
// tell how far. 2 % is what second order leaves.
TEST(CameraError, Hazard6MovesThePoseAsASolutionThroughAWrongCamera) {
  constexpr double kSaline = 1.3345, kLens_rad = 0.6, kSize_mm = 4;
  camera::Calibration on_the_centre = scope();
  on_the_centre.rotation_center_px = on_the_centre.principal_point_px;
  const RigidTransform truth{
      Eigen::Quaterniond(Eigen::AngleAxisd(2.6, Eigen::Vector3d(1, 0.3, 0.2).normalized())), {4, -3, 22}};
  for (const camera::Calibration& calibration : {scope(), on_the_centre}) {
    const camera::CameraModel camera(calibration, kLens_rad, kSaline);
    const TwistPerCameraError jacobian = twist_per_camera_error(truth, kSize_mm, camera).value();
    Eigen::Matrix<double, 6, 1> step;
    step << 0.5, 1e-3, 0.3, 0.3, 0.3, 0.3;
    for (int i = 0; i < 6; ++i) {
      const Eigen::Matrix<double, 6, 1> error = step[i] * Eigen::Matrix<double, 6, 1>::Unit(i);
      const camera::CameraModel wrong(off_by(calibration, error), kLens_rad, kSaline);
      const geometry::Vector6d moved =
          geometry::log(truth.inverse() * pose_through(camera, wrong, truth, kSize_mm));
      EXPECT_LT((jacobian * error - moved).norm(), 0.02 * moved.norm() + 1e-9) << "error " << i;
    }
  }
}

// Where it is largest, at the rim, it must not fall to nothing: past it a corner has no image, and of too few
// corners there is no pose.
TEST(CameraError, Hazard6IsNotSaidToBeNothingWhereItCannotBeSaid) {
  const camera::CameraModel camera(scope(), 0.6, 1.3345);
  const auto at = [&](const Eigen::Vector3d& place_mm) {
    return twist_per_camera_error(
        RigidTransform{Eigen::Quaterniond(Eigen::AngleAxisd(2.6, Eigen::Vector3d::UnitX())), place_mm}, 4.0,
        camera);
  };
  const auto middle = at({0, 0, 22});
  ASSERT_TRUE(middle);
  EXPECT_GT(middle->norm(), 0);
  EXPECT_FALSE(at({400, 0, 22}));
  EXPECT_FALSE(at({0, 0, -22}));
  const std::array<Eigen::Vector3d, 2> two{Eigen::Vector3d(-2, 0, 0), Eigen::Vector3d(2, 0, 0)};
  EXPECT_FALSE(
      twist_per_camera_error(RigidTransform{Eigen::Quaterniond::Identity(), {0, 0, 22}}, two, camera));
  EXPECT_FALSE(twist_per_camera_error(RigidTransform{Eigen::Quaterniond::Identity(), {0, 0, 22}},
                                      std::span<const Eigen::Vector3d>(), camera));
}

// Registration and guide are seen through the same camera: a focal length that is off moves both the same way
// when the guide stands where the bone was touched, and nothing is left of it.
TEST(ErrorBudget, Hazard6WhatRegistrationAndGuideShareCancels) {
  registration::RegistrationSummary registration;
  geometry::TrackedPose relative;
  relative.is_valid = true;
  relative.target_from_source.translation_mm = {12, 5, 3};
  KnownErrors known;
  known.camera = camera::nominal_covariance(scope());
  TwistPerCameraError shared = TwistPerCameraError::Random();
  Eigen::Matrix<double, 3, 6> at_tip;
  at_tip << Eigen::Matrix3d::Identity(), -geometry::cross_matrix({12, 5, 3});
  const PredictedError apart =
      predicted_error(twist_budget(registration, relative, shared, known), at_tip, Eigen::Matrix3d::Zero());
  known.registration.per_camera_error = shared;
  const PredictedError together =
      predicted_error(twist_budget(registration, relative, shared, known), at_tip, Eigen::Matrix3d::Zero());
  EXPECT_GT(apart.camera, 0.1);
  EXPECT_NEAR(together.camera, 0, 1e-9);
}

// A tip that is off moves every point by R * error. Held one way, the whole bone follows; the sums say so,
// and strokes may be summed apart.
TEST(RegistrationBias, Hazard6TheBoneFollowsTheTipThatDrewIt) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3d held = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
  BiasSums first, second;
  for (int i = 0; i < 60; ++i) {
    TipSensitivity point;
    point.tip_mm =
        Eigen::Vector3d(20, -5, 8) + 6 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    point.per_tip_error = held;
    // A camera error that turns the whole scene about the marker by 1 rad a unit, about z.
    point.per_camera_error.col(0) = Eigen::Vector3d::UnitZ().cross(point.tip_mm);
    (i % 2 == 0 ? first : second).add(point);
  }
  first += second;
  const RegistrationBias bias = first.bias();
  // The pull to no turn takes a ten-thousandth.
  EXPECT_LT((bias.per_tip_error.topRows<3>() - held).norm(), 1e-2);
  EXPECT_LT(bias.per_tip_error.bottomRows<3>().norm(), 1e-3);
  EXPECT_LT((bias.per_camera_error.col(0).tail<3>() - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
  EXPECT_LT(bias.per_camera_error.rightCols<5>().norm(), 1e-12);
}

// Where nobody knows how it was drawn, the tip's error counts whole; and points on one line are no crash.
TEST(RegistrationBias, WithoutPointsTheTipCountsWhole) {
  BiasSums sums;
  EXPECT_TRUE(sums.empty());
  EXPECT_EQ(sums.bias().per_tip_error.topRows<3>(), Eigen::Matrix3d::Identity());
  TipSensitivity point;
  point.tip_mm = {1, 2, 3};
  sums.add(point);
  EXPECT_TRUE(sums.bias().per_tip_error.allFinite());
  EXPECT_TRUE(sums.bias().per_camera_error.allFinite());
}

}  // namespace
}  // namespace arthronaut::guidance
