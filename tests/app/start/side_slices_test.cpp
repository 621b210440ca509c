#include "app/start/side_slices.h"

#include <gtest/gtest.h>

namespace arthronaut::start {
namespace {

// 100 mm each way; a bright rod along the leg at the patient's left and behind the middle.
images::Volume volume_with_rod() {
  images::Volume volume;
  volume.size = {50, 50, 50};
  volume.lps_from_index.linear() = 2.0 * Eigen::Matrix3d::Identity();
  volume.values.assign(50 * 50 * 50, 0);
  for (int k = 0; k < 50; ++k)
    for (int j = 30; j < 36; ++j)
      for (int i = 36; i < 42; ++i) volume.values[volume.index(i, j, k)] = 100;
  volume.modality = images::Modality::Mr;
  return volume;
}

// The patient's right is at the left of every picture, as its letters say, and so what lies at his left shows
// at the right.
TEST(SideSlices, ShowThePatientsLeftAtTheRight) {
  const auto slices = side_slices(volume_with_rod(), 100);
  ASSERT_EQ(slices.size(), 4U);
  for (const SideSlice& slice : slices) {
    SCOPED_TRACE(slice.words);
    EXPECT_EQ(slice.letters[0], "R");
    EXPECT_EQ(slice.letters[1], "L");
    ASSERT_EQ(slice.grey.size(), static_cast<std::size_t>(slice.size_px.x() * slice.size_px.y()));
    long left = 0, right = 0;
    for (int y = 0; y < slice.size_px.y(); ++y)
      for (int x = 0; x < slice.size_px.x(); ++x)
        (x < slice.size_px.x() / 2 ? left : right) +=
            slice.grey[static_cast<std::size_t>(y * slice.size_px.x() + x)];
    if (slice.words != slices.front().words) {  // the middle is in front of the rod
      EXPECT_GT(right, 2 * left);
    }
  }
  EXPECT_EQ(slices[0].letters[2], "H");
  EXPECT_EQ(slices[2].letters[2], "A");
  EXPECT_EQ(slices[2].letters[3], "P");
}

}  // namespace
}  // namespace arthronaut::start
