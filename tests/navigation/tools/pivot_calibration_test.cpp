#include "navigation/tools/pivot_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

#include "planning/geometry/error.h"

namespace arthronaut::tools {
namespace {

using geometry::RigidTransform;

const Eigen::Vector3d kTip(0.4, -22.8, -13.1);
const Eigen::Vector3d kPivot(12, -7, 25);

// A tool on its tip: the shaft inside a cone of this half-angle, turned about itself at will, with noise of
// the marker.
struct Motion {
  int count = 240;
  double cone_deg = 35, noise_mm = 0, noise_deg = 0, outlier_share = 0;
  unsigned seed = 7;

  [[nodiscard]] std::vector<RigidTransform> poses() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto noise = [&](double sigma) -> Eigen::Vector3d {
      const double x = sigma * gauss(random), y = sigma * gauss(random), z = sigma * gauss(random);
      return {x, y, z};
    };
    const Eigen::Vector3d shaft = -kTip.normalized(), across = shaft.unitOrthogonal();
    std::vector<RigidTransform> list;
    for (int i = 0; i < count; ++i) {
      const double around = geometry::kPi * uniform(random);
      const double cosine = 1 - (1 - std::cos(geometry::rad_from_deg(cone_deg))) * std::abs(uniform(random));
      const Eigen::Vector3d axis = Eigen::AngleAxisd(around, shaft) * across;
      Eigen::Quaterniond turn(Eigen::AngleAxisd(std::acos(cosine), axis));
      turn = turn * Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * uniform(random), shaft));
      RigidTransform pose{turn, kPivot - turn * kTip};
      geometry::Vector6d error;
      error << noise(noise_mm), noise(geometry::rad_from_deg(noise_deg));
      pose = pose * geometry::exp(error);
      if (std::abs(uniform(random)) < outlier_share) pose.translation_mm += noise(15.0);
      list.push_back(pose);
    }
    return list;
  }
};

// Noise-free poses give the tip to round-off.
TEST(PivotCalibration, IsExactWithoutNoise) {
  const auto summary = calibrate_pivot(Motion().poses());
  ASSERT_TRUE(summary.is_usable()) << summary.message;
  EXPECT_LT((summary.tip_in_tool_mm - kTip).norm(), 1e-8);
  EXPECT_LT((summary.pivot_in_fixed_mm - kPivot).norm(), 1e-8);
  EXPECT_NEAR(summary.cone_deg, 35, 3);
}

// A third of the poses thrown about must not move the tip by more than the noise does: 0.1 mm and 0.15 deg on
// a lever of 26 mm over 240 poses leave 0.02 mm.
TEST(PivotCalibration, IsNotMovedByOutliers) {
  Motion motion;
  motion.noise_mm = 0.05;
  motion.noise_deg = 0.15;
  motion.outlier_share = 0.33;
  const auto summary = calibrate_pivot(motion.poses());
  ASSERT_TRUE(summary.is_usable()) << summary.message;
  EXPECT_LT((summary.tip_in_tool_mm - kTip).norm(), 0.05);
  EXPECT_NEAR(summary.inlier_count, 0.67 * motion.count, 0.08 * motion.count);
}

// The covariance is the scatter of repeated calibrations: squared error over prediction averages to 1 an
// axis. 60 repetitions of 3 axes estimate that within 0.25 (two sigma, and the orientation noise is not
// isotropic).
TEST(PivotCalibration, PredictsItsScatter) {
  Motion motion;
  motion.noise_mm = 0.1;
  motion.noise_deg = 0.1;
  motion.count = 200;
  double sum = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    motion.seed = seed;
    const auto summary = calibrate_pivot(motion.poses());
    ASSERT_TRUE(summary.has_tip());
    const Eigen::Vector3d error = summary.tip_in_tool_mm - kTip;
    sum += error.dot(summary.tip_covariance_mm2.inverse() * error) / 3;
  }
  EXPECT_NEAR(sum / 60, 1.0, 0.35);
}

// The same poses written sixty times tell no more than once, whatever order they come in: squared error over
// prediction stays below 2, where it was 64.
TEST(PivotCalibration, Hazard6RepeatedPosesTellNoMore) {
  Motion motion;
  motion.noise_mm = 0.1;
  motion.noise_deg = 0.1;
  motion.count = 60;
  for (const bool in_turn : {false, true}) {
    double sum = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
      motion.seed = seed;
      const auto once = motion.poses();
      std::vector<RigidTransform> often;
      for (std::size_t i = 0; i < 60 * once.size(); ++i)
        often.push_back(once[in_turn ? i % once.size() : i / 60]);
      const auto summary = calibrate_pivot(often);
      const Eigen::Vector3d error = summary.tip_in_tool_mm - kTip;
      sum += error.dot(summary.tip_covariance_mm2.inverse() * error) / 3 / 60;
    }
    EXPECT_GT(sum, 0.5) << in_turn;
    EXPECT_LT(sum, 2.0) << in_turn;
  }
}

// Errors that follow the view, 0.1 mm in each patch of five degrees: frames average the patches and not
// themselves. Squared error over prediction stays below 2, where it was 4.
TEST(PivotCalibration, Hazard6ErrorsThatFollowTheViewAreNotAveragedAway) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    Motion motion;
    motion.count = 4000;
    motion.seed = seed;
    auto poses = motion.poses();
    for (RigidTransform& pose : poses) {
      const Eigen::AngleAxisd turn(pose.rotation);
      const Eigen::Vector3d place = turn.angle() * turn.axis() / geometry::rad_from_deg(5);
      std::seed_seq patch{static_cast<int>(seed), static_cast<int>(std::lround(place.x())),
                          static_cast<int>(std::lround(place.y())), static_cast<int>(std::lround(place.z()))};
      std::mt19937 random(patch);
      std::normal_distribution<double> gauss(0, 0.1);
      const double x = gauss(random), y = gauss(random), z = gauss(random);
      pose.translation_mm += Eigen::Vector3d(x, y, z);
    }
    const auto summary = calibrate_pivot(poses);
    const Eigen::Vector3d error = summary.tip_in_tool_mm - kTip;
    sum += error.dot(summary.tip_covariance_mm2.inverse() * error) / 3 / 16;
  }
  EXPECT_LT(sum, 2.0);
}

// What the halves differ by beyond chance is an error of the tip as well: a tip that slid by 0.2 mm half-way
// is off by half of that, and its error says at least so much along that way.
TEST(PivotCalibration, Hazard6TheTipsErrorHoldsWhatTheHalvesDifferBy) {
  PivotCalibrationSummary summary;
  summary.outcome = PivotCalibrationSummary::Outcome::Ok;
  summary.tip_in_tool_mm = {0, -20, 0};
  summary.tip_covariance_mm2 = 1e-6 * Eigen::Matrix3d::Identity();
  summary.tip_change_mm = {0.2, 0, 0};
  EXPECT_NEAR(std::sqrt(summary.tip_error_mm2()(0, 0)), 0.1, 0.001);
  EXPECT_NEAR(std::sqrt(summary.tip_error_mm2()(2, 2)), 0.001, 1e-6);
  summary.tip_covariance_mm2 = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(summary.tip_error_mm2()(0, 0), 0.01, 1e-12) << "no more than chance";
}

// What tools.json keeps holds the bias along the shaft as well.
TEST(PivotCalibration, Hazard6TheTipsErrorHoldsTheBias) {
  PivotCalibrationSummary summary;
  summary.outcome = PivotCalibrationSummary::Outcome::Ok;
  summary.tip_in_tool_mm = {0, -20, 0};
  summary.tip_covariance_mm2 = 0.0025 * Eigen::Matrix3d::Identity();
  summary.bias_mm = 0.1;
  EXPECT_NEAR(summary.tip_error_mm2()(1, 1), 0.0125, 1e-12);
  EXPECT_NEAR(summary.tip_error_mm2()(0, 0), 0.0025, 1e-12);
}

// A narrow cone has a beautiful residual and a wrong tip: refused, with the cone in the reason.
TEST(PivotCalibration, RefusesANarrowCone) {
  Motion motion;
  motion.cone_deg = 8;
  motion.noise_mm = 0.05;
  motion.noise_deg = 0.2;
  const auto summary = calibrate_pivot(motion.poses());
  EXPECT_EQ(summary.outcome, PivotCalibrationSummary::Outcome::ConeTooNarrow);
  EXPECT_LT(summary.rms_mm, 0.3);
  EXPECT_NE(summary.message.find("cone"), std::string::npos);
}

// A tip that slid half-way fits two places: the halves tell even when the residual passes.
TEST(PivotCalibration, RefusesATipThatSlid) {
  auto poses = Motion().poses();
  for (std::size_t i = poses.size() / 2; i < poses.size(); ++i)
    poses[i].translation_mm += Eigen::Vector3d(0.6, 0, 0);
  EXPECT_FALSE(calibrate_pivot(poses).is_usable());
}

// Nothing to go by is an outcome, not an exception and not a number.
TEST(PivotCalibration, RefusesTooFewPosesAndNoMotion) {
  EXPECT_EQ(calibrate_pivot({}).outcome, PivotCalibrationSummary::Outcome::TooFewPoses);
  const std::vector<RigidTransform> still(50);
  const auto summary = calibrate_pivot(still);
  EXPECT_EQ(summary.outcome, PivotCalibrationSummary::Outcome::NoPivot);
  EXPECT_FALSE(summary.has_tip());
  EXPECT_FALSE(PivotCalibrationSummary().is_usable());
}

// A swing in one plane leaves the tip free along the hinge.
// Where one half of the motion has no tip of its own, nobody is told of a difference in millimetres.
TEST(PivotCalibration, SaysThatOneHalfAloneTellsNoTip) {
  std::vector<RigidTransform> poses(240, Motion().poses().front());
  for (const RigidTransform& pose : Motion().poses()) poses.push_back(pose);
  const auto summary = calibrate_pivot(poses);
  EXPECT_FALSE(summary.is_usable());
  bool is_said = false;
  for (const std::string& reason : summary.reasons) {
    is_said = is_said || reason.find("one half of the motion alone") != std::string::npos;
    EXPECT_EQ(reason.find("1000"), std::string::npos) << reason;
  }
  EXPECT_TRUE(is_said);
  EXPECT_LT(summary.half_change_mm, 0) << "no number";
}

TEST(PivotCalibration, RefusesASwingInOnePlane) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.008 * (i - 100), Eigen::Vector3d::UnitX()));
    RigidTransform pose{turn, kPivot - turn * kTip};
    geometry::Vector6d error;
    for (int k = 0; k < 6; ++k) error[k] = gauss(random) * (k < 3 ? 0.05 : 0.002);
    poses.push_back(pose * geometry::exp(error));
  }
  const auto summary = calibrate_pivot(poses);
  EXPECT_FALSE(summary.is_usable());
}

// An option out of range is the caller's mistake.
TEST(PivotCalibration, RefusesOptionsOutOfRange) {
  PivotCalibrationOptions options;
  options.min_inlier_share = 1.5;
  EXPECT_THROW((void)calibrate_pivot(Motion().poses(), options), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::tools
