#include "app/scene/reslice.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::scene {
namespace {

// Its values are a linear function of the place in the patient, which trilinear interpolation has exactly,
// however the axes of the volume lie: oblique, with slices of another thickness, one axis mirrored.
images::Volume sloping(const Eigen::Vector3d& slope) {
  images::Volume volume;
  volume.size = {20, 24, 12};
  volume.lps_from_index.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
      Eigen::Vector3d(0.7, -0.7, 2.0).asDiagonal();
  volume.lps_from_index.translation() = Eigen::Vector3d(-40, 12, 300);
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 20; ++i)
        volume.values.push_back(
            static_cast<float>(slope.dot(volume.lps_from_index * Eigen::Vector3d(i, j, k))));
  return volume;
}

// The grey of every pixel is the value at the pixel's place through the window, to half a grey.
TEST(Reslice, EveryPixelIsTheVolumeAtItsPlace) {
  const Eigen::Vector3d slope(1.5, -2, 0.8);
  const images::Volume volume = sloping(slope);
  const Eigen::Vector3d middle = volume.lps_from_index * Eigen::Vector3d(10, 12, 6);
  SlicePlane plane;
  plane.center_mm = middle;
  plane.right = Eigen::Vector3d(1, 1, 0.2).normalized();
  plane.down = plane.right.unitOrthogonal();
  plane.mm_per_px = 0.31;
  const Eigen::Vector2i size(64, 50);
  const GreyWindow window{slope.dot(middle), 60};
  std::vector<std::uint8_t> grey;
  reslice(volume, plane, size, window, grey);
  ASSERT_EQ(grey.size(), 64U * 50);
  int inside = 0;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3d point = plane.point_at({x, y}, size);
      const Eigen::Vector3d index = volume.lps_from_index.inverse() * point;
      const bool is_inside = index.minCoeff() >= 0 && index.x() <= 19 && index.y() <= 23 && index.z() <= 11;
      const double value = 255 * ((slope.dot(point) - window.level) / window.width + 0.5);
      const double expected = is_inside ? std::clamp(value, 0.0, 255.0) : 0;
      ASSERT_NEAR(grey[static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)], expected, 0.52)
          << x << ", " << y;
      inside += is_inside ? 1 : 0;
    }
  EXPECT_GT(inside, 1000);
}

TEST(Reslice, ValueAtAPoint) {
  const Eigen::Vector3d slope(1.5, -2, 0.8);
  const images::Volume volume = sloping(slope);
  const Eigen::Vector3d point = volume.lps_from_index * Eigen::Vector3d(3.3, 7.9, 10.2);
  ASSERT_TRUE(value_at(volume, point));
  EXPECT_NEAR(*value_at(volume, point), slope.dot(point), 1e-3);  // single precision
  EXPECT_FALSE(value_at(volume, volume.lps_from_index * Eigen::Vector3d(3, 7, 11.2)));
}

// A pixel and its place are each other's inverse.
TEST(Reslice, PixelAndPlaceAreInverse) {
  SlicePlane plane;
  plane.center_mm = {3, -2, 9};
  plane.right = Eigen::Vector3d(0, 0.6, 0.8);
  plane.down = Eigen::Vector3d(1, 0, 0);
  const Eigen::Vector2i size(101, 77);
  EXPECT_NEAR(
      (plane.pixel_of(plane.point_at({12.5, 70.25}, size), size) - Eigen::Vector2d(12.5, 70.25)).norm(), 0,
      1e-9);
}

// A ball cut off its centre: every point of its outline lies on the circle that the plane cuts, and the
// outline goes all round.
TEST(Outline, OfABallIsACircle) {
  const geometry::TriangleMesh ball = test::ellipsoid({20, 20, 20}, 5);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, -1).normalized();
  const auto segments = outline_of(ball, 7 * normal, normal);
  double length = 0;
  for (const auto& [a, b] : segments) {
    for (const Eigen::Vector3d& point : {a, b}) {
      EXPECT_NEAR(normal.dot(point), 7, 1e-4);
      EXPECT_NEAR((point - 7 * normal).norm(), std::sqrt(400.0 - 49), 0.35);  // the sphere's facets
    }
    length += (b - a).norm();
  }
  EXPECT_NEAR(length, 2 * M_PI * std::sqrt(400.0 - 49), 1.5);
  EXPECT_TRUE(outline_of(ball, 21 * normal, normal).empty());
}

// The values of a label map are names: none of them is bone at 480 HU. W went through the windows of a CT, in
// which all is black.
TEST(Reslice, AWindowOfALabelMapIsNeverInHu) {
  images::Volume labels;
  labels.size = {4, 4, 4};
  labels.values.assign(64, 0);
  std::fill(labels.values.begin() + 32, labels.values.end(), 2.F);
  ASSERT_TRUE(images::is_label_map(labels));
  const GreyWindow automatic = automatic_window(labels);
  EXPECT_EQ(next_window(automatic, automatic, labels), automatic);
  EXPECT_EQ(next_window({7, 3}, automatic, labels), automatic);
  labels.modality = images::Modality::Ct;
  labels.values[5] = 40.5;
  ASSERT_FALSE(images::is_label_map(labels));
  EXPECT_EQ(next_window(automatic, automatic, labels), kBoneWindow);
}

// A key goes round the windows of a CT; an MR has one, however it was dragged.
TEST(Reslice, AWindowOfAnMrIsNeverInHu) {
  const GreyWindow automatic{300, 600}, dragged{100, 50};
  for (const images::Modality modality : {images::Modality::Ct, images::Modality::Unknown}) {
    EXPECT_EQ(next_window(kBoneWindow, automatic, modality), kSoftTissueWindow);
    EXPECT_EQ(next_window(kSoftTissueWindow, automatic, modality), automatic);
    EXPECT_EQ(next_window(automatic, automatic, modality), kBoneWindow);
    EXPECT_EQ(next_window(dragged, automatic, modality), kBoneWindow);
  }
  EXPECT_EQ(next_window(automatic, automatic, images::Modality::Mr), automatic);
  EXPECT_EQ(next_window(dragged, automatic, images::Modality::Mr), automatic);
}

// MR has no units: the window runs over what the values are, and a few bright voxels do not darken it.
TEST(GreyWindow, FollowsTheValues) {
  images::Volume volume;
  volume.size = {100, 100, 10};
  std::mt19937 random(3);
  for (int i = 0; i < 100'000; ++i) volume.values.push_back(static_cast<float>(random() % 1000));
  volume.values[17] = 60'000;
  const GreyWindow window = automatic_window(volume);
  EXPECT_NEAR(window.level - window.width / 2, 10, 5);
  EXPECT_NEAR(window.level + window.width / 2, 995, 5);
}

TEST(OrientationLetters, NameThePatientsSide) {
  EXPECT_EQ(orientation_letters({1, 0, 0}), "L");
  EXPECT_EQ(orientation_letters({-1, 0.2, 0}), "R");
  EXPECT_EQ(orientation_letters({0, 0.1, -1}), "F");
  EXPECT_EQ(orientation_letters({0.5, -0.8, 0}), "AL");
}

}  // namespace
}  // namespace arthronaut::scene
