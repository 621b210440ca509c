#include "navigation/tools/rig_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "navigation/tools/rig_problem.h"
#include "planning/geometry/error.h"
#include "tests/navigation/tools/mean_relative_poses.h"

namespace arthronaut::tools {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;
using Outcome = RigSummary::Outcome;

double angle_deg(const RigidTransform& a, const RigidTransform& b) {
  return geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation));
}

RigidTransform turned(const Eigen::Vector3d& axis, double deg, const Eigen::Vector3d& at_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis.normalized())), at_mm};
}

// A body that is waved before a camera; what is seen of its markers is off as poses from corners are that are
// off by so many pixels.
class Rig : public ::testing::Test {
 protected:
  Rig() { options_.markers = {{2, 4.0}, {12, 3.0}, {13, 3.0}}; }

  // About 20 to 30 mm away, swung by about cone_deg.
  RigidTransform wave(double time_s, double cone_deg) const {
    const double a = geometry::rad_from_deg(cone_deg);
    RigidTransform tilt = turned(Eigen::Vector3d::UnitX(), geometry::deg_from_rad(a * std::sin(1.7 * time_s)),
                                 Eigen::Vector3d::Zero());
    tilt = tilt * turned(Eigen::Vector3d::UnitY(), geometry::deg_from_rad(a * std::cos(1.1 * time_s)),
                         Eigen::Vector3d::Zero());
    tilt = tilt * turned(Eigen::Vector3d::UnitZ(), 40 * std::sin(0.4 * time_s), Eigen::Vector3d::Zero());
    // The face looks at the camera.
    RigidTransform pose{Eigen::Quaterniond(0, 1, 0, 0),
                        {2 * std::sin(time_s), 1.5, 25 + 4 * std::cos(0.7 * time_s)}};
    return pose * tilt;
  }

  // Corners of the true pose, each off by noise, and the pose nearest to them by Gauss-Newton from the truth.
  RigidTransform seen(const RigidTransform& truth, double size_mm) {
    const auto corners_mm = rig_corners_mm(size_mm);
    Eigen::Matrix<double, 8, 1> noisy;
    for (int k = 0; k < 4; ++k)
      noisy.segment<2>(2 * k) = *rig_project(truth * corners_mm[static_cast<std::size_t>(k)]) +
                                noise_px_ * Eigen::Vector2d(normal_(random_), normal_(random_));
    RigidTransform pose = truth;
    for (int round = 0; round < 8; ++round) {
      Eigen::Matrix<double, 8, 6> jacobian;
      Eigen::Matrix<double, 8, 1> residual;
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector3d& corner = corners_mm[static_cast<std::size_t>(k)];
        const Eigen::Vector3d at = pose * corner;
        Eigen::Matrix<double, 2, 3> d_pixel;
        d_pixel << 1, 0, -at.x() / at.z(), 0, 1, -at.y() / at.z();
        d_pixel *= kRigFocal_px / at.z();
        jacobian.block<2, 3>(2 * k, 0) = d_pixel * pose.matrix();
        jacobian.block<2, 3>(2 * k, 3) = -d_pixel * pose.matrix() * geometry::cross_matrix(corner);
        residual.segment<2>(2 * k) = noisy.segment<2>(2 * k) - *rig_project(at);
      }
      const geometry::Matrix6d normal = jacobian.transpose() * jacobian;
      const Vector6d step = normal.ldlt().solve(jacobian.transpose() * residual);
      if (!step.allFinite() || step.norm() > 5) break;
      pose = pose * geometry::exp(step);
    }
    return pose;
  }

  struct Waving {
    int frames = 600;
    double cone_deg = 25;
    int moves_at = -1;    // from this frame on marker 12 lies elsewhere
    int wrong_every = 0;  // marker 13 is far off in each of so many frames
    int apart_from = -1;  // from this frame on 13 is seen with the others, before alone
  };
  std::vector<RigSighting> wave_of(const Waving& how) {
    std::vector<RigSighting> sightings;
    for (int i = 0; i < how.frames; ++i) {
      const double time_s = i / 30.0;
      const RigidTransform pose = wave(time_s, how.cone_deg);
      for (std::size_t m = 0; m < 3; ++m) {
        if (how.apart_from >= 0 && (m == 2) != (i >= how.apart_from)) continue;
        RigidTransform at = truth_[m];
        if (m == 1 && how.moves_at >= 0 && i >= how.moves_at) at = at * turned({1, 0, 0}, 1.0, {0.3, 0, 0});
        RigidTransform camera_from_marker = seen(pose * at, options_.markers[m].second);
        if (m == 2 && how.wrong_every > 0 && i % how.wrong_every == 0)
          camera_from_marker = camera_from_marker * turned({0, 1, 0}, 35, {1.5, 1, 0});
        sightings.push_back({i, time_s, options_.markers[m].first, camera_from_marker});
      }
    }
    return sightings;
  }

  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
  double noise_px_ = 0.15;
  RigOptions options_;
  const std::array<RigidTransform, 3> truth_{RigidTransform(), turned({0, 1, 0}, 25, {5.6, 2.0, -1.4}),
                                             turned({0.2, -1, 0.1}, 25, {-5.2, 1.0, -1.2})};
};

// Without noise the places are the truth's.
TEST_F(Rig, IsExactWithoutNoise) {
  noise_px_ = 0;
  const RigSummary rig = calibrate_rig(wave_of({.frames = 300}), options_);
  ASSERT_TRUE(rig.is_usable()) << rig.message;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((rig.places[i].reference_from_marker.translation_mm - truth_[i].translation_mm).norm(), 1e-4);
    EXPECT_LT(angle_deg(rig.places[i].reference_from_marker, truth_[i]), 1e-3);
  }
  EXPECT_LT(rig.rms_mm, 1e-4);
}

// Corners off by 0.15 px: places to hundredths of a millimetre, as predicted. Two markers of 6 numbers in
// each of 12 waves: a mean of 1 with a sigma of about 0.15 of which clusters of frames take some more.
TEST_F(Rig, ErrorIsAsPredicted) {
  double sum = 0;
  for (int wave = 0; wave < 12; ++wave) {
    const RigSummary rig = calibrate_rig(wave_of({.frames = 200}), options_);
    ASSERT_TRUE(rig.has_places()) << rig.message;
    for (std::size_t i = 1; i < 3; ++i) {
      const Vector6d error = geometry::log(rig.places[i].reference_from_marker.inverse() * truth_[i]);
      sum += error.dot(rig.places[i].covariance.ldlt().solve(error)) / 6;
      EXPECT_LT(error.head<3>().norm(), 0.06);
    }
  }
  EXPECT_GT(sum / 24, 0.5);
  EXPECT_LT(sum / 24, 2);
}

// All sightings together beat the mean of relative poses, by half at least.
TEST_F(Rig, BeatsTheMeanOfRelativePoses) {
  double joint = 0, mean = 0;
  for (int wave = 0; wave < 5; ++wave) {
    const auto sightings = wave_of({.frames = 300, .wrong_every = 20});
    const RigSummary rig = calibrate_rig(sightings, options_);
    const auto means = test::mean_relative_poses(sightings, options_);
    ASSERT_TRUE(rig.has_places()) << rig.message;
    for (std::size_t i = 1; i < 3; ++i) {
      joint += std::pow(angle_deg(rig.places[i].reference_from_marker, truth_[i]), 2);
      mean += std::pow(angle_deg(*means[i], truth_[i]), 2);
    }
  }
  EXPECT_LT(std::sqrt(joint), 0.5 * std::sqrt(mean));
}

// A tenth of one marker's poses is wrong by far: they are told and leave no mark.
TEST_F(Rig, LeavesWrongPosesOut) {
  const RigSummary rig = calibrate_rig(wave_of({.frames = 300, .wrong_every = 10}), options_);
  ASSERT_TRUE(rig.is_usable()) << rig.message;
  EXPECT_NEAR(rig.sighting_count - rig.inlier_count, 30, 8);
  EXPECT_LT((rig.places[2].reference_from_marker.translation_mm - truth_[2].translation_mm).norm(), 0.05);
}

// The frame is that of the marker asked for; the places stay the same ones.
TEST_F(Rig, TakesTheReferenceAskedFor) {
  const auto sightings = wave_of({.frames = 300});
  options_.reference_id = 12;
  const RigSummary rig = calibrate_rig(sightings, options_);
  ASSERT_TRUE(rig.has_places()) << rig.message;
  EXPECT_EQ(rig.places[1].reference_from_marker.translation_mm, Eigen::Vector3d::Zero());
  EXPECT_EQ(rig.places[0].marker_id, 2);
  EXPECT_LT((rig.places[0].reference_from_marker.translation_mm - truth_[1].inverse().translation_mm).norm(),
            0.08);
}

// A marker that slipped by 0.3 mm in the middle, or a third of the way: told, with its id, and not to be
// used.
TEST_F(Rig, TellsAMarkerThatMoved) {
  for (const int at : {150, 100, 210}) {
    const RigSummary rig = calibrate_rig(wave_of({.frames = 300, .moves_at = at}), options_);
    EXPECT_FALSE(rig.is_usable()) << at;
    EXPECT_EQ(rig.changed_id, 12) << at;
    const bool is_said = std::any_of(rig.reasons.begin(), rig.reasons.end(), [](const std::string& reason) {
      return reason.find("marker 12 moved") != std::string::npos;
    });
    EXPECT_TRUE(is_said) << at << ": " << rig.message;
  }
}

// Markers that are never seen together, a wave that is none, a marker that is never seen: each with its
// reason.
TEST_F(Rig, RefusesWhatTellsTooLittle) {
  RigSummary rig = calibrate_rig(wave_of({.frames = 200, .apart_from = 100}), options_);
  EXPECT_EQ(rig.outcome, Outcome::NeverTogether);
  EXPECT_NE(rig.message.find("marker 13 is not seen together"), std::string::npos) << rig.message;
  EXPECT_FALSE(rig.has_places());
  rig = calibrate_rig(wave_of({.frames = 200, .cone_deg = 1.5}), options_);
  EXPECT_EQ(rig.outcome, Outcome::TooFewViews) << rig.message;
  EXPECT_NE(rig.message.find("too little motion"), std::string::npos) << rig.message;
  rig = calibrate_rig(wave_of({.frames = 8}), options_);
  EXPECT_EQ(rig.outcome, Outcome::NeverTogether) << rig.message;
  const auto sightings = wave_of({.frames = 30});
  options_.markers = {{2, 4.0}, {40, 4.0}};
  rig = calibrate_rig(sightings, options_);
  EXPECT_EQ(rig.outcome, Outcome::TooFewMarkers) << rig.message;
  rig = calibrate_rig({}, options_);
  EXPECT_EQ(rig.outcome, Outcome::TooFewMarkers) << rig.message;
}

// What cannot be asked.
TEST_F(Rig, RefusesOptionsOutOfRange) {
  const auto refuses = [&](const auto& change) {
    RigOptions options = options_;
    change(options);
    EXPECT_THROW((void)calibrate_rig({}, options), InvalidInput);
  };
  refuses([](RigOptions& o) { o.markers.resize(1); });
  refuses([](RigOptions& o) { o.markers[1].first = 2; });
  refuses([](RigOptions& o) { o.markers[1].second = 0; });
  refuses([](RigOptions& o) { o.reference_id = 9; });
  refuses([](RigOptions& o) { o.max_rms_mm = -1; });
}

}  // namespace
}  // namespace arthronaut::tools
