#include "planning/painting/label_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/painting/shapes.h"

namespace arthronaut::painting {
namespace {

using Eigen::Vector3d;

class LabelEdits : public ::testing::Test {
 protected:
  images::Volume volume_ = test::empty_volume({80, 60, 50}, {0.8, 0.8, 1.0});
  Labels labels_ = Labels(volume_.values.size(), kNothing);
  [[nodiscard]] std::size_t count(std::uint8_t label) const {
    return static_cast<std::size_t>(std::count(labels_.begin(), labels_.end(), label));
  }
};

TEST_F(LabelEdits, ThresholdFillsWhatHoldsNothing) {
  volume_.values[10] = 300;
  volume_.values[11] = 250;
  volume_.values[12] = 249.5F;
  volume_.values[13] = 900;
  labels_[13] = kTibia;
  add_above(labels_, volume_, 250, kFemur);
  EXPECT_EQ(count(kFemur), 2U);
  EXPECT_EQ(labels_[13], kTibia);
}

TEST_F(LabelEdits, TheLargestIslandStays) {
  test::add_ball(labels_, volume_, {20, 20, 20}, 8, kFemur);
  const std::size_t largest = count(kFemur);
  test::add_ball(labels_, volume_, {45, 20, 20}, 5, kFemur);
  test::add_ball(labels_, volume_, {20, 40, 40}, 2, kTibia);
  const Labels before = labels_;
  const std::size_t all = count(kFemur), other = count(kTibia);
  EXPECT_EQ(keep_largest(labels_, volume_, kFemur), all - largest);
  EXPECT_EQ(count(kFemur), largest);
  EXPECT_EQ(count(kTibia), other);
  EXPECT_EQ(keep_largest(labels_, volume_, kSurroundings), 0U);
}

// A shell becomes a ball; one with a gap only when the gap is closed; what another bone holds stays.
TEST_F(LabelEdits, HolesAreFilledAndGapsClosed) {
  const Vector3d center(30, 24, 25);
  Labels solid = labels_;
  test::add_ball(solid, volume_, center, 14, kFemur);
  labels_ = solid;
  test::add_ball(labels_, volume_, center, 10, kNothing);
  const auto inside = volume_.index(37, 30, 25);
  ASSERT_EQ(labels_[inside], kNothing);
  labels_[inside] = kTibia;
  solid[inside] = kTibia;
  const Labels shell = labels_;
  fill_holes(labels_, volume_, kFemur);
  EXPECT_EQ(labels_, solid);
  // A channel of 2 mm through the shell along x and up through it: open in space and in the slice.
  labels_ = shell;
  test::for_each_voxel(volume_, [&](std::size_t v, const Vector3d& p) {
    if (std::hypot(p.y() - center.y(), p.z() - center.z()) < 1.1 && p.x() > center.x()) labels_[v] = kNothing;
  });
  const Labels open = labels_;
  fill_holes(labels_, volume_, kFemur);
  EXPECT_EQ(labels_[volume_.index(33, 30, 25)], kNothing) << "the channel leads into it";
  EXPECT_EQ(labels_[volume_.index(33, 30, 30)], kFemur) << "closed within its slice";
  labels_ = open;
  fill_holes(labels_, volume_, kFemur, 2);
  fill_holes(solid, volume_, kFemur, 2);  // which rounds the steps of a ball of voxels off
  std::size_t off = 0;
  for (std::size_t v = 0; v < labels_.size(); ++v) off += (labels_[v] == kFemur) != (solid[v] == kFemur);
  // But for the channel's mouth: into its 4 mm2 the ball of 2 mm bulges by less than a voxel.
  EXPECT_LT(off, 8U);
}

// Two balls of 10 mm whose centres lie 16 mm apart, all one label: the narrowest section is half-way, and
// there they are parted, whatever the strokes' sizes.
TEST_F(LabelEdits, TouchingBonesArePartedAtTheirNeck) {
  const Vector3d a(20, 24, 25), b(36, 24, 25);
  test::add_ball(labels_, volume_, a, 10, kFemur);
  test::add_ball(labels_, volume_, b, 10, kFemur);
  test::add_ball(labels_, volume_, {58, 10, 8}, 3, kFemur);  // no stroke in it: stays
  const Labels before = labels_;
  Labels strokes(labels_.size(), kNothing);
  test::add_ball(strokes, volume_, a + Vector3d(-6, 0, 0), 2, kFemur);
  test::add_ball(strokes, volume_, b + Vector3d(0, 6, 0), 1, kTibia);
  part_by_strokes(labels_, volume_, strokes);
  std::size_t wrong = 0, both = 0;
  test::for_each_voxel(volume_, [&](std::size_t v, const Vector3d& p) {
    ASSERT_EQ(labels_[v] == kNothing, before[v] == kNothing);
    if (labels_[v] == kNothing || p.x() > 50) return;
    ++both;
    wrong += (labels_[v] == kFemur) != (p.x() < 28);
  });
  // The neck's plane lies in a voxel, whose section has 6 mm of radius: of 176 voxels half may be either's.
  EXPECT_LT(wrong, 200U);
  EXPECT_GT(both, 10000U);
  EXPECT_EQ(labels_[volume_.index(72, 12, 8)], kFemur);
}

// Shells with strokes in their marrow: parted where they touch, and still shells.
TEST_F(LabelEdits, ShellsArePartedByStrokesInTheirMarrow) {
  const Vector3d a(20, 24, 25), b(36, 24, 25);
  test::add_ball(labels_, volume_, a, 10, kFemur);
  test::add_ball(labels_, volume_, b, 10, kFemur);
  test::add_ball(labels_, volume_, a, 7, kNothing);
  test::add_ball(labels_, volume_, b, 7, kNothing);
  const Labels before = labels_;
  Labels strokes(labels_.size(), kNothing);
  test::add_ball(strokes, volume_, a, 2, kFemur);
  test::add_ball(strokes, volume_, b, 2, kTibia);
  part_by_strokes(labels_, volume_, strokes);
  std::size_t wrong = 0;
  test::for_each_voxel(volume_, [&](std::size_t v, const Vector3d& p) {
    ASSERT_EQ(labels_[v] == kNothing, before[v] == kNothing) << "nothing is filled by it";
    wrong += labels_[v] != kNothing && (labels_[v] == kFemur) != (p.x() < 28);
  });
  EXPECT_LT(wrong, 200U);  // of the neck's plane, as above
  EXPECT_GT(count(kTibia), 2000U);
}

TEST_F(LabelEdits, StrokesOfSurroundingsTakeAwayAndAreAskedForInBoth) {
  const Vector3d a(20, 24, 25), b(36, 24, 25);
  test::add_ball(labels_, volume_, a, 10, kFemur);
  test::add_ball(labels_, volume_, b, 10, kFemur);
  Labels strokes(labels_.size(), kNothing);
  const Labels before = labels_;
  test::add_ball(strokes, volume_, a, 2, kFemur);
  test::add_ball(strokes, volume_, {55, 40, 40}, 2, kTibia);  // beside the bones
  EXPECT_THAT(test::message_of<InvalidInput>([&] { part_by_strokes(labels_, volume_, strokes); }),
              testing::HasSubstr("each of the bones"));
  EXPECT_EQ(labels_, before);
  test::add_ball(strokes, volume_, b, 2, kSurroundings);
  part_by_strokes(labels_, volume_, strokes);
  EXPECT_EQ(labels_[volume_.index(45, 30, 25)], kNothing);
  EXPECT_EQ(labels_[volume_.index(25, 30, 25)], kFemur);
  Labels empty(labels_.size(), kNothing);
  EXPECT_THROW(part_by_strokes(empty, volume_, strokes), InvalidInput);
}

// A cylinder, drawn as discs in every fifth slice: straight between them, so it is exact.
TEST_F(LabelEdits, BetweenSlicesACylinderIsExact) {
  const auto is_in = [](const Vector3d& p) { return std::hypot(p.x() - 30, p.y() - 24) <= 9; };
  Labels truth = labels_;
  test::for_each_voxel(volume_, [&](std::size_t v, const Vector3d& p) {
    const long slice = std::lround(p.z());
    if (!is_in(p) || slice < 10 || slice > 40) return;
    truth[v] = kTibia;
    if (slice % 5 == 0) labels_[v] = kTibia;
  });
  fill_between(labels_, volume_, axis_along(volume_, Vector3d::UnitZ()), kTibia);
  EXPECT_EQ(labels_, truth);
}

TEST_F(LabelEdits, SmoothingTakesSpecksAndKeepsTheVolume) {
  test::add_ball(labels_, volume_, {30, 24, 25}, 12, kFemur);
  const double before_ml = volume_ml(labels_, volume_, kFemur);
  EXPECT_NEAR(before_ml, 4.0 / 3 * std::numbers::pi * 1.728, 0.05);
  labels_[volume_.index(60, 50, 40)] = kFemur;
  smooth(labels_, volume_, kFemur, 1.5);
  EXPECT_EQ(labels_[volume_.index(60, 50, 40)], kNothing);
  EXPECT_NEAR(volume_ml(labels_, volume_, kFemur), before_ml, 0.01 * before_ml);
}

}  // namespace
}  // namespace arthronaut::painting
