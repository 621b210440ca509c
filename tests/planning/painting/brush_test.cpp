#include "planning/painting/brush.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/planning/painting/shapes.h"

namespace arthronaut::painting {
namespace {

using Eigen::Vector3d;

std::size_t count(const Labels& labels) {
  return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), kFemur));
}

// Against the area of a disc and of a bar with round ends: one layer, of the slice that is nearest.
TEST(Brush, PaintsADiscAndALineInOneSlice) {
  const images::Volume volume = test::empty_volume({100, 100, 9}, {0.5, 0.5, 2}, {-25, -25, -8});
  for (const double length_mm : {0.0, 20.0}) {
    Labels labels(volume.values.size(), kNothing);
    LabelChange change;
    const Vector3d from(-9.87, 1.23, 0.7);
    paint(labels, volume, {from, from + Vector3d(length_mm, 0, 0), Vector3d::UnitZ(), {6, false}}, kFemur,
          change);
    const double area = std::numbers::pi * 36 + 12 * length_mm;
    // Half a voxel along the border of about 38 to 78 mm, of either sign by turns.
    EXPECT_NEAR(static_cast<double>(count(labels)) * 0.25, area, 0.03 * area);
    for (std::size_t v = 0; v < labels.size(); ++v) ASSERT_TRUE(labels[v] == kNothing || v / 10000 == 4);
    change.undo(labels);
    EXPECT_EQ(count(labels), 0U);
  }
}

TEST(Brush, ABallHasItsVolumeInVoxelsOfAnyShape) {
  const images::Volume volume = test::empty_volume({80, 60, 30}, {0.5, 0.7, 1.3});
  Labels labels(volume.values.size(), kNothing);
  LabelChange change;
  const Vector3d at(20.1, 20.2, 20.3);
  paint(labels, volume, {at, at, Vector3d::UnitX(), {8, true}}, kFemur, change);
  const double ball = 4.0 / 3 * std::numbers::pi * 512;
  EXPECT_NEAR(static_cast<double>(count(labels)) * 0.5 * 0.7 * 1.3, ball, 0.02 * ball);
}

// In a grid that is turned against the slice: wherever one looks within the disc, the voxel there is painted.
TEST(Brush, ADiscInAnObliqueGridHasNoHoles) {
  images::Volume volume = test::empty_volume({60, 60, 60}, {1, 1, 1});
  volume.lps_from_index.linear() =
      Eigen::AngleAxisd(0.5, Vector3d(1, 2, 0.3).normalized()).toRotationMatrix();
  const Vector3d at = volume.lps_from_index * Vector3d(30, 30, 30);
  Labels labels(volume.values.size(), kNothing);
  LabelChange change;
  paint(labels, volume, {at, at, Vector3d::UnitZ(), {12, false}}, kFemur, change);
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  for (double y = -10; y <= 10; y += 0.5) {
    for (double x = -10; x <= 10; x += 0.5) {
      if (std::hypot(x, y) > 10.5) continue;
      const Eigen::Vector3i v =
          (index_from_lps * Vector3d(at + Vector3d(x, y, 0))).array().round().cast<int>();
      ASSERT_EQ(labels[volume.index(v.x(), v.y(), v.z())], kFemur) << x << " " << y;
    }
  }
}

// However the grid lies under the slice: every voxel that the slice passes through near the line, and no
// other.
TEST(Brush, ADiscTakesWhatItIsSaidToTake) {
  for (const double turn_rad : {0.0, 0.3, 0.8}) {
    images::Volume volume = test::empty_volume({40, 50, 30}, {1, 0.7, 2});
    volume.lps_from_index.linear() =
        Eigen::AngleAxisd(turn_rad, Vector3d(1, 2, 0.3).normalized()) * volume.lps_from_index.linear();
    const Vector3d from = volume.lps_from_index * Vector3d(18, 20, 14.2);
    const Vector3d along(5, 3, 0), to = from + along;
    constexpr double kRadius_mm = 6;
    Labels labels(volume.values.size(), kNothing), expected = labels;
    LabelChange change;
    paint(labels, volume, {from, to, Vector3d::UnitZ(), {kRadius_mm, false}}, kFemur, change);
    const double half_mm = 0.5 * volume.lps_from_index.linear().row(2).cwiseAbs().sum();
    test::for_each_voxel(volume, [&](std::size_t v, const Vector3d& p) {
      const Vector3d in_slice(p.x() - from.x(), p.y() - from.y(), 0);
      const double share = std::clamp(in_slice.dot(along) / along.squaredNorm(), 0.0, 1.0);
      if (std::abs(p.z() - from.z()) < half_mm && (in_slice - share * along).norm() <= kRadius_mm)
        expected[v] = kFemur;
    });
    EXPECT_EQ(labels, expected) << turn_rad;
    EXPECT_GT(count(labels), 100U);
  }
}

TEST(Brush, ASmallBrushPaintsTheVoxelUnderItAndNothingOutside) {
  const images::Volume volume = test::empty_volume({10, 10, 10}, {2, 2, 2});
  Labels labels(volume.values.size(), kNothing);
  LabelChange change;
  paint(labels, volume, {{7.1, 7.1, 7.1}, {7.1, 7.1, 7.1}, Vector3d::UnitZ(), {0.1, false}}, kFemur, change);
  EXPECT_EQ(count(labels), 1U);
  EXPECT_EQ(labels[volume.index(4, 4, 4)], kFemur);
  paint(labels, volume, {{-50, 0, 0}, {-60, 0, 0}, Vector3d::UnitZ(), {3, true}}, kFemur, change);
  EXPECT_EQ(count(labels), 1U);
}

}  // namespace
}  // namespace arthronaut::painting
