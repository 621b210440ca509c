#include "app/scene/drawn_volume.h"

#include <gtest/gtest.h>

#include "app/scene/reslice.h"

namespace arthronaut::scene {
namespace {

using Eigen::Vector3d;

// Values that say where they are: linear in the place, so that a mean of voxels is the value at their middle.
images::Volume ramp(const Eigen::Vector3i& size, const Vector3d& spacing_mm) {
  images::Volume volume;
  volume.modality = images::Modality::Ct;
  volume.size = size;
  volume.lps_from_index.linear() =
      Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix() * spacing_mm.asDiagonal();
  volume.lps_from_index.translation() = Vector3d(-20, 5, 300);
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const Vector3d at = volume.lps_from_index * Vector3d(i, j, k);
        volume.values.push_back(static_cast<float>(Vector3d(3, -4, 5).dot(at - Vector3d(-20, 5, 300))));
      }
  return volume;
}
const geometry::Bounds kAll{Vector3d::Constant(-1e4), Vector3d::Constant(1e4)};

// Each of the fewer voxels has the value of the place where it is said to be, to a half of a Hounsfield unit.
TEST(DrawnVolumeTest, VoxelsLieWhereTheirValuesWere) {
  const images::Volume volume = ramp({61, 47, 30}, {0.4, 0.5, 1.1});
  for (const std::size_t most : {1'000'000U, 20'000U, 3'000U}) {
    const auto drawn = drawn_volume(volume, kAll, most);
    ASSERT_NE(drawn, nullptr);
    ASSERT_EQ(drawn->levels.size(), static_cast<std::size_t>(drawn->size.prod()));
    EXPECT_LE(drawn->levels.size(), most);
    EXPECT_GT(drawn->levels.size(), most / 4 < 86'010 ? most / 4 : 86'009);
    for (const Eigen::Vector3i& at : {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(3, 2, 1),
                                      Eigen::Vector3i(drawn->size - Eigen::Vector3i::Ones())}) {
      const std::size_t index =
          static_cast<std::size_t>(at.x() + drawn->size.x() * (at.y() + drawn->size.y() * at.z()));
      const double value = drawn->lowest + drawn->per_level * drawn->levels[index];
      const auto there = value_at(volume, drawn->lps_from_index * at.cast<double>());
      ASSERT_TRUE(there.has_value());
      EXPECT_NEAR(value, *there, 0.51) << most << ": " << at.transpose();
    }
  }
}

// Blocks come near to cubes: the thick slices of a CT stay as they are.
TEST(DrawnVolumeTest, BringsDownTheFineAxesFirst) {
  const auto drawn = drawn_volume(ramp({80, 80, 20}, {0.4, 0.4, 1.6}), kAll, 10'000);
  ASSERT_NE(drawn, nullptr);
  EXPECT_EQ(drawn->size.z(), 20);
  EXPECT_LT(drawn->size.x(), 40);
}

// Only what lies about the joint, and all of that.
TEST(DrawnVolumeTest, HoldsTheBoxAndLittleElse) {
  images::Volume volume = ramp({100, 100, 100}, {1, 1, 1});
  volume.lps_from_index = Eigen::Translation3d(-50, -50, -50);
  const auto drawn = drawn_volume(volume, {{-10.4, -5, 0}, {10.4, 5, 30}});
  ASSERT_NE(drawn, nullptr);
  EXPECT_EQ(drawn->size, Eigen::Vector3i(23, 11, 31));
  EXPECT_EQ((drawn->lps_from_index * Vector3d::Zero()), Vector3d(-11, -5, 0));
  EXPECT_EQ(drawn_volume(volume, {{60, 60, 60}, {70, 70, 70}}), nullptr) << "beside the images";
}

// An MR's values mean nothing by themselves: they are spread over its own range, and so are its thresholds.
TEST(DrawnVolumeTest, AnMrIsSpreadOverItsOwnRange) {
  images::Volume volume = ramp({40, 40, 40}, {1, 1, 1});
  volume.modality = images::Modality::Mr;
  for (float& value : volume.values) value = 100 + 3 * std::abs(value);
  const auto drawn = drawn_volume(volume, kAll);
  ASSERT_NE(drawn, nullptr);
  EXPECT_FALSE(drawn->is_ct);
  const GreyWindow window = automatic_window(volume);
  EXPECT_NEAR(drawn->lowest, window.level - window.width / 2, 1e-9);
  EXPECT_EQ(*std::ranges::max_element(drawn->levels), 1023);
  double threshold = first_threshold(*drawn);
  EXPECT_NEAR(threshold, drawn->lowest + window.width / 10, 1e-9);
  for (int i = 0; i < 100; ++i) threshold = moved_threshold(*drawn, threshold, 1);
  EXPECT_LT(threshold, window.level + window.width / 2);
  EXPECT_GT(threshold, window.level + window.width / 2 - window.width / 20);
}

TEST(DrawnVolumeTest, ACtBeginsAtTheThresholdOfBone) {
  images::Volume volume = ramp({20, 20, 20}, {1, 1, 1});
  volume.modality = images::Modality::Unknown;
  EXPECT_FALSE(drawn_volume(volume, kAll)->is_ct);
  volume.modality = images::Modality::Ct;
  const auto drawn = drawn_volume(volume, kAll);
  EXPECT_TRUE(drawn->is_ct);
  EXPECT_EQ(first_threshold(*drawn), 250);
  EXPECT_EQ(moved_threshold(*drawn, 250, -2), 200);
}

}  // namespace
}  // namespace arthronaut::scene
