// A bone's cortex, dark in an MR: a ball of marrow in a shell of cortex, whose radii are known.
#include "planning/segmentation/dark_rim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/geometry/surface.h"
#include "planning/images/bone_surface.h"
#include "planning/images/voxel_mask.h"
#include "tests/planning/segmentation/known_mr.h"

namespace arthronaut::segmentation {
namespace {

using Eigen::Vector3d;

constexpr double kMarrow_mm = 14, kBone_mm = 15.2;
constexpr std::uint8_t kBone = 3;
const Vector3d kMiddle(20, 20, 20);

struct Greys {
  double marrow = 700, cortex = 60, around = 350, noise = 25;
};

// Half a millimetre a voxel; each is filled by what it covers, along the radius.
images::Volume ball(const Greys& greys, double bone_mm = kBone_mm) {
  images::Volume volume;
  volume.size = {81, 81, 81};
  volume.lps_from_index.linear() = Vector3d(0.5, 0.5, 0.5).asDiagonal();
  volume.modality = images::Modality::Mr;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, greys.noise);
  for (int k = 0; k < 81; ++k)
    for (int j = 0; j < 81; ++j)
      for (int i = 0; i < 81; ++i) {
        const double r = (volume.lps_from_index * Vector3d(i, j, k) - kMiddle).norm();
        const auto within = [&](double radius) { return std::clamp((radius - r) / 0.5 + 0.5, 0.0, 1.0); };
        const double grey = greys.around + (greys.cortex - greys.around) * within(bone_mm) +
                            (greys.marrow - greys.cortex) * within(kMarrow_mm);
        volume.values.push_back(static_cast<float>(grey + noise(random)));
      }
  return volume;
}

Labels labelled(const images::Volume& volume, double radius_mm) {
  Labels labels(volume.values.size(), 0);
  std::size_t v = 0;
  for (int k = 0; k < 81; ++k)
    for (int j = 0; j < 81; ++j)
      for (int i = 0; i < 81; ++i, ++v)
        if ((volume.lps_from_index * Vector3d(i, j, k) - kMiddle).norm() <= radius_mm) labels[v] = kBone;
  return labels;
}

// Of a ball with as many voxels.
double radius_mm(const Labels& labels) {
  const auto count = static_cast<double>(std::ranges::count(labels, kBone));
  return std::cbrt(count * 0.125 * 3 / (4 * std::numbers::pi));
}

DarkRim take_in(Labels& labels, const images::Volume& volume) {
  return take_in_dark_rim(labels, volume, kBone, {}, {});
}

// The bright marrow alone was painted, or half of the cortex with it.
TEST(DarkRim, TheCortexBecomesBone) {
  for (const double around : {350.0, 900.0}) {
    const images::Volume mr = ball({.around = around});
    for (const double painted_mm : {kMarrow_mm, kMarrow_mm + 0.6}) {
      Labels labels = labelled(mr, painted_mm);
      const DarkRim rim = take_in(labels, mr);
      EXPECT_GT(rim.share, 0.9);
      EXPECT_NEAR(rim.thickness_mm, kBone_mm - painted_mm, 0.3);
      EXPECT_NEAR(radius_mm(labels), kBone_mm, 0.15);
    }
  }
}

// As fat-suppressed images have it: marrow darker than what surrounds the bone.
TEST(DarkRim, TheCortexIsDarkerThanDarkMarrowToo) {
  const images::Volume mr = ball({.marrow = 250, .cortex = 40, .around = 600, .noise = 10});
  Labels labels = labelled(mr, kMarrow_mm);
  EXPECT_TRUE(take_in(labels, mr).is_seen());
  EXPECT_NEAR(radius_mm(labels), kBone_mm, 0.2);
}

// No rim, one that is in already, and a CT, in which fat is dark beside bone: nothing changes.
TEST(DarkRim, WhatHasNoRimStays) {
  for (const Greys& greys : {Greys{.marrow = 250, .cortex = 250, .around = 600},
                             Greys{.marrow = 700, .cortex = 700, .around = 300, .noise = 60}}) {
    const images::Volume mr = ball(greys);
    Labels labels = labelled(mr, kBone_mm);
    const Labels before = labels;
    EXPECT_FALSE(take_in(labels, mr).is_seen());
    EXPECT_EQ(labels, before);
  }
  Labels whole = labelled(ball({}), kBone_mm);
  EXPECT_FALSE(take_in(whole, ball({})).is_seen());
  EXPECT_NEAR(radius_mm(whole), kBone_mm, 0.1);
  images::Volume ct = ball({});
  ct.modality = images::Modality::Ct;
  Labels of_ct = labelled(ct, kMarrow_mm);
  EXPECT_FALSE(take_in(of_ct, ct).is_seen());
  EXPECT_EQ(of_ct, labelled(ct, kMarrow_mm));
}

// A tendon, as dark as the cortex that it comes from: the bone goes on beneath it as it does beside it.
TEST(DarkRim, ATendonIsNoBone) {
  images::Volume mr = ball({});
  for (int k = 0; k < 81; ++k)
    for (int j = 0; j < 81; ++j)
      for (int i = 0; i < 81; ++i) {
        const Vector3d from = mr.lps_from_index * Vector3d(i, j, k) - kMiddle;
        if (from.x() > kMarrow_mm && from.tail<2>().norm() < 4) mr.values[mr.index(i, j, k)] = 60;
      }
  Labels labels = labelled(mr, kMarrow_mm);
  ASSERT_TRUE(take_in(labels, mr).is_seen());
  // Along the tendon's middle.
  for (int i = 40; i < 81; ++i) {
    const double along_mm = 0.5 * i - kMiddle.x();
    if (along_mm < kBone_mm - 0.4) {
      EXPECT_EQ(labels[mr.index(i, 40, 40)], kBone) << along_mm;
    }
    if (along_mm > kBone_mm + 0.6) {
      EXPECT_EQ(labels[mr.index(i, 40, 40)], 0) << along_mm;
    }
  }
}

// What a person painted stays, and so does another bone.
TEST(DarkRim, StrokesAndOtherBonesStay) {
  const images::Volume mr = ball({});
  Labels labels = labelled(mr, kMarrow_mm), seeds(labels.size(), 0);
  const std::size_t painted = mr.index(69, 40, 40), other = mr.index(40, 69, 40);  // both in the cortex
  seeds[painted] = 1;
  labels[painted] = 1;
  labels[other] = 5;
  const std::uint8_t others[] = {5};
  EXPECT_TRUE(take_in_dark_rim(labels, mr, kBone, others, seeds).is_seen());
  EXPECT_EQ(labels[painted], 1);
  EXPECT_EQ(labels[other], 5);
  seeds.pop_back();
  EXPECT_THROW((void)take_in_dark_rim(labels, mr, kBone, others, seeds), InvalidInput);
}

// The built-in knee in an MR that shows its marrow bright and 1.2 mm of its cortex dark, ten strokes: grown,
// the bones end at their marrow; with the rim they are the bones.
TEST(DarkRim, BonesGrownFromStrokesHaveTheirCortex) {
  const images::Volume truth = test::known_labels();
  images::Volume mr = truth;
  mr.modality = images::Modality::Mr;
  for (float& value : mr.values) value = 380;
  for (const float label : {5.0F, 6.0F}) {
    images::VoxelMask bone(truth.size);
    for (std::size_t v = 0; v < truth.values.size(); ++v) bone.inside[v] = truth.values[v] == label;
    const std::vector<float> depths = images::depths_mm(bone, truth.spacing_mm());
    for (std::size_t v = 0; v < depths.size(); ++v)
      if (bone.inside[v]) mr.values[v] = depths[v] > 1.2F ? 700.0F : 60.0F;
  }
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 25);
  for (float& value : mr.values) value += noise(random);
  const Labels seeds = test::strokes(truth, {5, 6});
  Labels labels = grow_from_seeds(mr, seeds);
  const auto off_mm = [&](int label) {
    images::Volume grown = truth;
    grown.values.assign(labels.begin(), labels.end());
    const geometry::Surface exact(images::surface_of_label(truth, label).mesh);
    std::vector<double> distances;
    for (const auto& p : images::surface_of_label(grown, label).mesh.vertices_mm)
      distances.push_back((exact.closest_point(p).point_mm - p).norm());
    return geometry::median(std::move(distances));
  };
  for (const std::uint8_t label : {5, 6}) {
    const double before_mm = off_mm(label);
    const std::uint8_t others[] = {static_cast<std::uint8_t>(11 - label)};
    EXPECT_TRUE(take_in_dark_rim(labels, mr, label, others, seeds).is_seen());
    const double after_mm = off_mm(label);
    RecordProperty("label_" + std::to_string(label),
                   std::to_string(before_mm) + " -> " + std::to_string(after_mm));
    EXPECT_GT(before_mm, 0.6);
    EXPECT_LT(after_mm, 0.3);  // what is asked of bones that are grown from strokes
  }
}

// Of a surface: how much of the bone it leaves out.
TEST(DarkRim, ASurfaceTellsWhatItLeavesOut) {
  const images::Volume mr = ball({});
  images::Volume grid = mr;
  const auto surface_of = [&](double radius) {
    const Labels labels = labelled(mr, radius);
    grid.values.assign(labels.begin(), labels.end());
    return images::surface_of_label(grid, kBone).mesh;
  };
  const DarkRim marrow = rim_outside(surface_of(kMarrow_mm), mr);
  EXPECT_TRUE(marrow.is_seen());
  EXPECT_NEAR(marrow.thickness_mm, kBone_mm - kMarrow_mm, 0.25);
  EXPECT_FALSE(rim_outside(surface_of(kBone_mm), mr).is_seen());
}

}  // namespace
}  // namespace arthronaut::segmentation
