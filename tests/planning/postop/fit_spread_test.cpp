// Lines through numbers whose noise is known, and how many neighbours share it.
#include "planning/postop/fit_spread.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace arthronaut::postop {
namespace {

constexpr Eigen::Index kVoxels = 3840, kParts = 60, kTrials = 300;

// A line is fitted to noise that so many neighbours share; `actual` is how far its two numbers are off, as
// mean squares, `said` by the noise that is told.
struct Told {
  Eigen::Vector2d actual = Eigen::Vector2d::Zero(), said = Eigen::Vector2d::Zero();
  double shared_voxels = 0;
};
Told told_of(Eigen::Index sharing) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  Told told;
  for (Eigen::Index trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    Eigen::MatrixXd rows(kVoxels, 2), by_part = Eigen::MatrixXd::Zero(2, kParts);
    Eigen::VectorXd values(kVoxels);
    for (Eigen::Index v = 0; v < kVoxels; ++v) {
      rows.row(v) << 1, 2.0 * static_cast<double>(v) / kVoxels - 1;
      values[v] = v % sharing == 0 ? noise(random) : values[v - 1];
      normal += rows.row(v).transpose() * rows.row(v);
      right += values[v] * rows.row(v).transpose();
    }
    const Eigen::Vector2d numbers = normal.inverse() * right;
    for (Eigen::Index v = 0; v < kVoxels; ++v)
      by_part.col(v * kParts / kVoxels) += (values[v] - rows.row(v).dot(numbers)) * rows.row(v).transpose();
    const FitSpread spread = spread_of(normal, by_part);
    told.actual += numbers.cwiseAbs2() / kTrials;
    told.said += spread.by_noise.diagonal() / kTrials;
    told.shared_voxels += spread.shared_voxels / kTrials;
  }
  return told;
}

}  // namespace

// Noise that every voxel has alone, and noise that 8 share: as far off as is said, less what is added for
// grain and levels. Limits: four times what 300 trials leave uncertain of a variance.
TEST(FitSpread, SaysHowFarTheNumbersAreOff) {
  for (const Eigen::Index sharing : {1, 8}) {
    SCOPED_TRACE(sharing);
    const Told told = told_of(sharing);
    EXPECT_NEAR(told.shared_voxels, static_cast<double>(sharing), 0.2 * static_cast<double>(sharing));
    for (int number = 0; number < 2; ++number)
      EXPECT_NEAR(told.actual[number] / told.said[number], 1 / 1.5, 4 * std::sqrt(2.0 / kTrials) / 1.5);
  }
}

// A number that nothing tells of takes no part in what the others say of the noise.
TEST(FitSpread, WhatNothingIsSeenOfDoesNotHideTheNoise) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(2, 2), by_part(2, 4);
  by_part << 2, -2, 2, -2, 0, 0, 0, 0;
  EXPECT_NEAR(spread_of(normal, by_part).shared_voxels, 16.0 * 4 / 3, 1e-9);
}

}  // namespace arthronaut::postop
