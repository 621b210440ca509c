#include "navigation/tools/spin_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "planning/geometry/error.h"

namespace arthronaut::tools {
namespace {

using geometry::RigidTransform;

const Eigen::Vector3d kDirection = Eigen::Vector3d(0.1, -1, 0.05).normalized();
const Eigen::Vector3d kPoint(0.5, -24, -3.3);

// A guide turned in a sleeve that stands at will, sliding along it a little.
std::vector<RigidTransform> spin(double turn_deg, double noise_mm, double noise_deg, int count = 120,
                                 unsigned seed = 11, const Eigen::Vector3d& direction = kDirection) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  const RigidTransform fixed_from_sleeve{Eigen::Quaterniond(0.6, 0.4, -0.5, 0.3).normalized(), {4, -9, 31}};
  std::vector<RigidTransform> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = geometry::rad_from_deg(turn_deg) * i / (count - 1);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, direction));
    RigidTransform sleeve_from_tool{turn, kPoint - turn * kPoint + direction * 2 * std::sin(angle)};
    geometry::Vector6d error;
    for (int k = 0; k < 6; ++k)
      error[k] = gauss(random) * (k < 3 ? noise_mm : geometry::rad_from_deg(noise_deg));
    poses.push_back(fixed_from_sleeve * sleeve_from_tool * geometry::exp(error));
  }
  return poses;
}

double distance_from_axis(const Eigen::Vector3d& point) { return (point - kPoint).cross(kDirection).norm(); }

// Noise-free poses give the axis to round-off; sliding along it does not matter.
TEST(SpinCalibration, IsExactWithoutNoise) {
  const auto summary = calibrate_spin(spin(200, 0, 0));
  ASSERT_TRUE(summary.is_usable()) << summary.message;
  EXPECT_LT(geometry::angle_between_rad(summary.axis_direction_in_tool, kDirection), 1e-7);
  EXPECT_LT(distance_from_axis(summary.axis_point_in_tool_mm), 1e-6);
  EXPECT_NEAR(summary.axis_point_in_tool_mm.dot(kDirection), 0, 1e-4);
  EXPECT_NEAR(summary.turn_deg, 200, 1);
}

// Turning tells no more than the line: which way a guide drills along it is what was declared, and where
// nothing is, and it does not point down the marker either, it is not told.
TEST(SpinCalibration, PointsTheWayThatWasDeclared) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    const std::vector<RigidTransform> poses = spin(200, 0.02, 0.02, 120, 11, direction);
    const auto declared =
        calibrate_spin(poses, {.declared_direction = direction + Eigen::Vector3d(0.2, 0, 0)});
    ASSERT_TRUE(declared.is_usable()) << declared.message;
    EXPECT_GT(declared.axis_direction_in_tool.dot(direction), 0.999);
    const auto across = calibrate_spin(poses, {.declared_direction = Eigen::Vector3d::UnitX()});
    EXPECT_EQ(across.outcome, SpinCalibrationSummary::Outcome::DirectionUnknown);
    EXPECT_NE(across.message.find("off the declared direction"), std::string::npos) << across.message;
  }
  const auto unknown = calibrate_spin(spin(200, 0.02, 0.02, 120, 11, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(unknown.outcome, SpinCalibrationSummary::Outcome::DirectionUnknown);
  EXPECT_NE(unknown.message.find("declare axis_direction"), std::string::npos) << unknown.message;
}

// 0.2 deg of orientation noise over 120 poses leaves 0.03 deg of the axis; 4 sigma of that, and the lever of
// 24 mm.
TEST(SpinCalibration, AveragesNoise) {
  const auto summary = calibrate_spin(spin(200, 0.05, 0.2));
  ASSERT_TRUE(summary.is_usable()) << summary.message;
  EXPECT_LT(geometry::deg_from_rad(geometry::angle_between_rad(summary.axis_direction_in_tool, kDirection)),
            0.15);
  EXPECT_LT(distance_from_axis(summary.axis_point_in_tool_mm), 0.1);
  EXPECT_GT(summary.direction_sigma_deg, 0.01);
}

// What is said of the axis is the scatter of repeated calibrations: the mean square of error over prediction
// lies near 1 for the point, which is of two coordinates, and for the direction, whose figure is of both
// together and is careful by half. 60 repetitions, of noise beside which what no number of poses averages
// away is small.
TEST(SpinCalibration, Hazard6PredictsItsScatter) {
  for (const double turn_deg : {120.0, 340.0}) {
    double point = 0, direction = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
      const auto summary = calibrate_spin(spin(turn_deg, 0.1, 0.5, 120, seed));
      const double miss_mm = distance_from_axis(summary.axis_point_in_tool_mm);
      const double miss_deg =
          geometry::deg_from_rad(geometry::angle_between_rad(summary.axis_direction_in_tool, kDirection));
      point += miss_mm * miss_mm / (2 * summary.point_sigma_mm * summary.point_sigma_mm) / 60;
      direction += miss_deg * miss_deg / (2 * summary.direction_sigma_deg * summary.direction_sigma_deg) / 60;
    }
    EXPECT_GT(point, 0.5) << turn_deg;
    EXPECT_LT(point, 2.0) << turn_deg;
    EXPECT_GT(direction, 0.2) << turn_deg;
    EXPECT_LT(direction, 2.0) << turn_deg;
  }
}

// Two rests have an axis that fits them exactly, whatever it is off by: no number of frames makes it known.
TEST(SpinCalibration, Hazard6RefusesTwoRestsHoweverManyFrames) {
  const auto two = spin(100, 0.1, 1, 2);
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 40; ++i) poses.push_back(two[static_cast<std::size_t>(i) % 2]);
  const auto summary = calibrate_spin(poses);
  EXPECT_FALSE(summary.is_usable());
  EXPECT_EQ(summary.place_count, 2);
  EXPECT_NE(summary.message.find("2 places"), std::string::npos) << summary.message;
  EXPECT_GT(summary.direction_sigma_deg, 0.02);
}

// A pose that is written sixty times is no more than one: squared error over prediction stays below 2, where
// it was 60.
TEST(SpinCalibration, Hazard6RepeatedPosesTellNoMore) {
  double direction = 0, point = 0;
  constexpr unsigned kTrials = 60;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const auto once = spin(160, 0.1, 0.2, 20, seed);
    std::vector<RigidTransform> often;
    for (const RigidTransform& pose : once) often.insert(often.end(), 60, pose);
    const auto said = calibrate_spin(often);
    const double miss_mm = distance_from_axis(said.axis_point_in_tool_mm);
    const double miss_deg =
        geometry::deg_from_rad(geometry::angle_between_rad(said.axis_direction_in_tool, kDirection));
    point += miss_mm * miss_mm / (2 * said.point_sigma_mm * said.point_sigma_mm) / kTrials;
    direction += miss_deg * miss_deg / (2 * said.direction_sigma_deg * said.direction_sigma_deg) / kTrials;
  }
  EXPECT_LT(point, 2.0);
  EXPECT_LT(direction, 2.0);
}

// Some poses thrown about are left out.
TEST(SpinCalibration, LeavesOutliersOut) {
  auto poses = spin(220, 0.03, 0.1);
  for (std::size_t i = 0; i < poses.size(); i += 9) {
    poses[i] = poses[i] * RigidTransform{Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())),
                                         {3, 1, 0}};
  }
  const auto summary = calibrate_spin(poses);
  ASSERT_TRUE(summary.is_usable()) << summary.message;
  EXPECT_LT(summary.inlier_count, summary.pose_count - 8);
  EXPECT_LT(distance_from_axis(summary.axis_point_in_tool_mm), 0.1);
}

// A small turn cannot tell the axis from its neighbours.
TEST(SpinCalibration, RefusesASmallTurn) {
  EXPECT_EQ(calibrate_spin(spin(50, 0.05, 0.2)).outcome, SpinCalibrationSummary::Outcome::TurnTooSmall);
  EXPECT_EQ(calibrate_spin({}).outcome, SpinCalibrationSummary::Outcome::TooFewPoses);
  SpinCalibrationOptions options;
  options.max_rms_mm = 0;
  EXPECT_THROW((void)calibrate_spin(spin(200, 0, 0), options), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::tools
