// Lines through numbers whose noise is known, and how many neighbours share it.
#include "planning/postop/fit_spread.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace arthronaut::postop {
namespace {

constexpr Eigen::Index kVoxels = 3840, kTrials = 300;

// A line is fitted to noise that so many neighbours share; `actual` is how far its two numbers are off, as
// mean squares, `said` by the noise that is told and `said_by_parts` by how they disagree.
struct Told {
  Eigen::Vector2d actual = Eigen::Vector2d::Zero(), said = Eigen::Vector2d::Zero(),
                  said_by_parts = Eigen::Vector2d::Zero();
  double shared_voxels = 0, freedom = 0;
};
Told told_of(Eigen::Index sharing, Eigen::Index parts) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  Told told;
  for (Eigen::Index trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    Eigen::MatrixXd rows(kVoxels, 2);
    std::vector<PartOfFit> by_part(static_cast<std::size_t>(parts),
                                   {Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)});
    Eigen::VectorXd values(kVoxels);
    for (Eigen::Index v = 0; v < kVoxels; ++v) {
      rows.row(v) << 1, 2.0 * static_cast<double>(v) / kVoxels - 1;
      values[v] = v % sharing == 0 ? noise(random) : values[v - 1];
      normal += rows.row(v).transpose() * rows.row(v);
      right += values[v] * rows.row(v).transpose();
    }
    const Eigen::Vector2d numbers = normal.inverse() * right;
    for (Eigen::Index v = 0; v < kVoxels; ++v) {
      PartOfFit& part = by_part[static_cast<std::size_t>(v * parts / kVoxels)];
      part.normal += rows.row(v).transpose() * rows.row(v);
      part.right += (values[v] - rows.row(v).dot(numbers)) * rows.row(v).transpose();
    }
    const FitSpread spread = spread_of(normal, by_part);
    told.actual += numbers.cwiseAbs2() / kTrials;
    told.said += spread.by_noise.diagonal() / kTrials;
    told.said_by_parts += spread.by_disagreement.diagonal() / kTrials;
    told.freedom = spread.freedom;
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
    const Told told = told_of(sharing, 60);
    EXPECT_NEAR(told.shared_voxels, static_cast<double>(sharing), 0.2 * static_cast<double>(sharing));
    for (int number = 0; number < 2; ++number)
      EXPECT_NEAR(told.actual[number] / told.said[number], 1 / 1.5, 4 * std::sqrt(2.0 / kTrials) / 1.5);
  }
}

// Few parts, of which each draws the line to itself: they disagree with it by less than it is off, which what
// they say must not follow. More than a variance from 300 trials is uncertain (8 %) must not lack.
TEST(FitSpread, FewPartsDoNotHideHowFarTheNumbersAreOff) {
  const Told told = told_of(8, 6);
  EXPECT_EQ(told.freedom, 4);
  for (int number = 0; number < 2; ++number)
    EXPECT_GT(told.said_by_parts[number], 0.9 * told.actual[number]) << number;
}

// A number that nothing tells of takes no part in what the others say of the noise.
TEST(FitSpread, WhatNothingIsSeenOfDoesNotHideTheNoise) {
  const Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(2, 2);
  std::vector<PartOfFit> by_part;
  for (const double right : {2, -2, 2, -2})
    by_part.push_back({0.25 * Eigen::Vector2d(1, 0).asDiagonal().toDenseMatrix(), Eigen::Vector2d(right, 0)});
  EXPECT_NEAR(spread_of(normal, by_part).shared_voxels, 16.0 * 4 / 3, 1e-9);
}

// Errors in a plane, of which only an estimate of their sigma is known: as many are beyond the limit as was
// asked for. Limit: four times what 20000 draws leave uncertain.
TEST(FitSpread, TheLargestSigmaLeavesTheChanceThatWasAskedFor) {
  constexpr double kLimit = 0.5, kChance = 0.02;
  constexpr int kDraws = 20000;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const int freedom : {6, 40}) {
    SCOPED_TRACE(freedom);
    const double estimate = largest_sigma(kLimit, kChance, freedom);
    std::chi_squared_distribution<double> squares(freedom);
    int beyond = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const double sigma = estimate / std::sqrt(squares(random) / freedom);
      beyond += sigma * M_SQRT1_2 * std::hypot(normal(random), normal(random)) > kLimit ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(beyond) / kDraws, kChance, 4 * std::sqrt(kChance / kDraws));
  }
}

}  // namespace arthronaut::postop
