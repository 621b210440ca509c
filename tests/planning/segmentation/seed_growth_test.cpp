// Labels grown from strokes in an MR that was made from known labels.
#include "planning/segmentation/seed_growth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/images/bone_surface.h"
#include "tests/message_of.h"
#include "tests/planning/segmentation/known_mr.h"

namespace arthronaut::segmentation {
namespace {

using testing::HasSubstr;

double dice(const Labels& labels, const images::Volume& truth, int label) {
  std::size_t grown = 0, true_count = 0, both = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const bool is_grown = labels[v] == label, is_true = truth.values[v] == static_cast<float>(label);
    grown += is_grown;
    true_count += is_true;
    both += is_grown && is_true;
  }
  return 2.0 * static_cast<double>(both) / static_cast<double>(grown + true_count);
}

// What was asked for: Dice 0.97, half of the surface within 0.3 mm. With the noise of a good and a poor scan.
TEST(SeedGrowth, TenStrokesFindBothBones) {
  const images::Volume truth = test::known_labels();
  const Labels seeds = test::strokes(truth, {5, 6});
  for (const double noise : {20.0, 60.0}) {
    const Labels labels = grow_from_seeds(test::known_mr(truth, noise), seeds);
    images::Volume grown = truth;
    grown.values.assign(labels.begin(), labels.end());
    for (const int label : {5, 6}) {
      EXPECT_GT(dice(labels, truth, label), 0.97) << noise;
      const geometry::Surface exact(images::surface_of_label(truth, label).mesh);
      std::vector<double> distances;
      for (const auto& p : images::surface_of_label(grown, label).mesh.vertices_mm)
        distances.push_back((exact.closest_point(p).point_mm - p).norm());
      std::nth_element(distances.begin(), distances.begin() + std::ssize(distances) / 2, distances.end());
      EXPECT_LT(distances[distances.size() / 2], 0.3) << noise;
    }
    for (std::size_t v = 0; v < seeds.size(); ++v) {
      ASSERT_NE(labels[v], 0);
      ASSERT_TRUE(seeds[v] == 0 || labels[v] == seeds[v]);
    }
  }
}

TEST(SeedGrowth, WhatIsNotPaintedIsAskedFor) {
  images::Volume volume;
  volume.size = {4, 4, 4};
  volume.values.assign(64, 1.0F);
  Labels seeds(64, 0);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)grow_from_seeds(volume, seeds); }),
              HasSubstr("fewer than two labels"));
  seeds.resize(63);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)grow_from_seeds(volume, seeds); }),
              HasSubstr("grid"));
  // Without any contrast the nearer stroke wins.
  seeds.assign(64, 0);
  seeds[volume.index(0, 0, 0)] = 1;
  seeds[volume.index(3, 0, 0)] = 2;
  const Labels labels = grow_from_seeds(volume, seeds);
  EXPECT_EQ(labels[volume.index(1, 3, 3)], 1);
  EXPECT_EQ(labels[volume.index(2, 3, 3)], 2);
}

// A ball painted in every fifth slice.
TEST(SeedGrowth, ABallIsFilledBetweenItsSlices) {
  images::Volume grid;
  grid.size = {60, 60, 61};
  grid.lps_from_index.linear() = Eigen::Vector3d(0.5, 0.5, 0.5).asDiagonal();
  grid.values.assign(60 * 60 * 61, 0.0F);
  Labels labels(grid.values.size(), 0);
  const auto is_in = [](int i, int j, int k) {
    return (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(30, 30, 30)).norm() <= 21;
  };
  std::size_t inside = 0, wrong = 0;
  for (int k = 10; k <= 50; k += 5) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i) labels[grid.index(i, j, k)] = is_in(i, j, k) ? 7 : 0;
    }
  }
  labels[grid.index(30, 30, 32)] = 3;  // another's voxel stays
  fill_between_slices(labels, grid, 2, 7);
  for (int k = 10; k <= 50; ++k) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i) {
        inside += is_in(i, j, k);
        wrong += (labels[grid.index(i, j, k)] == 7) != is_in(i, j, k);
      }
    }
  }
  EXPECT_EQ(labels[grid.index(30, 30, 32)], 3);
  // Between slices 2.5 mm apart a ball of 10.5 mm bulges by 0.07 mm over the straight line, most near its
  // poles.
  EXPECT_LT(static_cast<double>(wrong), 0.04 * static_cast<double>(inside));
}

TEST(SeedGrowth, SmoothingRoundsOffAndDoesNotShrink) {
  images::Volume grid;
  grid.size = {50, 50, 50};
  grid.values.assign(125000, 0.0F);
  Labels labels(125000, 1);
  std::size_t before = 0, after = 0;
  for (int k = 0; k < 50; ++k) {
    for (int j = 0; j < 50; ++j) {
      for (int i = 0; i < 50; ++i) {
        if ((Eigen::Vector3d(i, j, k) - Eigen::Vector3d(25, 25, 25)).norm() > 16) continue;
        labels[grid.index(i, j, k)] = 2;
        ++before;
      }
    }
  }
  labels[grid.index(25, 25, 45)] = 2;  // a speck
  labels[grid.index(25, 25, 25)] = 1;  // a hole
  smooth_label(labels, grid, 2, 2.0, 1);
  for (const auto label : labels) after += label == 2;
  EXPECT_EQ(labels[grid.index(25, 25, 45)], 1);
  EXPECT_EQ(labels[grid.index(25, 25, 25)], 2);
  // Voxels at the level itself, of which a ball has 48 that are alike.
  EXPECT_NEAR(static_cast<double>(after), static_cast<double>(before), 48);
}

}  // namespace
}  // namespace arthronaut::segmentation
