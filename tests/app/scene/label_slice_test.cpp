#include "app/scene/label_slice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::scene {
namespace {

class LabelSlice : public ::testing::Test {
 protected:
  LabelSlice() {
    volume_.size = {20, 10, 4};
    volume_.lps_from_index.linear() = Eigen::Vector3d(1, 2, 3).asDiagonal();
    volume_.lps_from_index.translation() = Eigen::Vector3d(-5, 7, 11);
    volume_.values.assign(800, 0.0F);
    labels_.assign(800, 0);
  }
  static constexpr std::uint32_t kRed = 0x400000FFU, kGreen = 0x4000FF00U;
  images::Volume volume_;
  std::vector<std::uint8_t> labels_;
  // Half a mm a pixel: the slice k = 2, and 10 mm of nothing about it.
  const SlicePlane plane_{{4.5, 16, 17}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 0.5};
  const Eigen::Vector2i size_px_{80, 80};
  std::vector<std::uint32_t> rgba_;
};

// Each pixel against the voxel that it lies in, found here from the voxel's own six faces.
TEST_F(LabelSlice, EveryPixelHasTheLabelOfItsVoxel) {
  for (int j = 2; j < 6; ++j)
    for (int i = 3; i < 17; ++i) labels_[volume_.index(i, j, 2)] = i < 9 ? 1 : 2;
  const std::vector<LabelLayer> layers{{.labels = labels_, .colors = {0, kRed, kGreen}}};
  draw_labels(volume_, layers, plane_, size_px_, rgba_);
  ASSERT_EQ(rgba_.size(), 6400U);
  const auto label_at = [&](int x, int y) {
    const Eigen::Vector3d p = plane_.point_at({x, y}, size_px_);
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 20; ++i)
        if (std::abs(p.x() - (i - 5)) < 0.5 && std::abs(p.y() - (7 + 2 * j)) < 1)
          return static_cast<int>(labels_[volume_.index(i, j, 2)]);
    return 0;
  };
  int painted = 0;
  for (int y = 1; y < 79; ++y) {
    for (int x = 1; x < 79; ++x) {
      const int label = label_at(x, y);
      const std::uint32_t pixel = rgba_[static_cast<std::size_t>(80 * y + x)];
      painted += label > 0;
      if (label == 0) {
        ASSERT_EQ(pixel, 0U) << x << " " << y;
      } else {
        const bool is_border = label_at(x - 1, y) != label || label_at(x + 1, y) != label ||
                               label_at(x, y - 1) != label || label_at(x, y + 1) != label;
        const std::uint32_t color = label == 1 ? kRed : kGreen;
        ASSERT_EQ(pixel, is_border ? color | 0xFF000000U : color) << x << " " << y;
      }
    }
  }
  EXPECT_EQ(painted, 14 * 4 * 2 * 4);  // voxels of 1 mm x 2 mm, at half a mm a pixel
}

TEST_F(LabelSlice, ALaterLayerCoversAndAThresholdIsDrawnWithoutLabels) {
  labels_[volume_.index(10, 4, 2)] = 1;
  volume_.values[volume_.index(10, 4, 2)] = 400;
  volume_.values[volume_.index(12, 4, 2)] = 400;
  volume_.values[volume_.index(14, 4, 2)] = 399;
  const std::vector<LabelLayer> layers{{.threshold = 400.0F, .colors = {0, kGreen}},
                                       {.labels = labels_, .colors = {0, kRed}}};
  draw_labels(volume_, layers, plane_, size_px_, rgba_);
  const auto at = [&](int i) {
    const Eigen::Vector2d p = plane_.pixel_of(volume_.lps_from_index * Eigen::Vector3d(i, 4, 2), size_px_);
    return rgba_[static_cast<std::size_t>(80 * std::lround(p.y()) + std::lround(p.x()))] & 0xFFFFFFU;
  };
  EXPECT_EQ(at(10), kRed & 0xFFFFFFU);
  EXPECT_EQ(at(12), kGreen & 0xFFFFFFU);
  EXPECT_EQ(at(14), 0U);
}

}  // namespace
}  // namespace arthronaut::scene
