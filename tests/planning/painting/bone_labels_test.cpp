#include "planning/painting/bone_labels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/planning/geometry/shapes.h"
#include "tests/planning/painting/shapes.h"

namespace arthronaut::painting {
namespace {

using Eigen::Vector3d;

images::Volume grid_of(bool mirrored) {
  images::Volume grid;
  grid.size = {50, 44, 36};
  grid.lps_from_index.linear() = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
                                 Vector3d(0.9, 1, mirrored ? -1.2 : 1.2).asDiagonal();
  grid.lps_from_index.translation() -= grid.lps_from_index.linear() * (0.5 * grid.size.cast<double>());
  return grid;
}

// A voxel is the bone's where its centre lies in the ellipsoid, as the ellipsoid's own equation has it, in
// oblique and in mirrored images. The mesh is inscribed: centres within its 0.02 mm of the surface may be
// out.
TEST(BoneLabels, AreTheVoxelsWhoseCentresLieInTheBone) {
  const Vector3d radii(14, 11, 9), center(1.5, -2, 3);
  const geometry::TriangleMesh mesh = test::ellipsoid(radii, 5, center);
  for (const bool mirrored : {false, true}) {
    const images::Volume grid = grid_of(mirrored);
    Labels labels(static_cast<std::size_t>(grid.size.prod()), kNothing);
    add_bone(labels, grid, mesh, kTibia);
    std::size_t inside = 0;
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          const Vector3d at = grid.lps_from_index * Vector3d(i, j, k);
          const double r = (at - center).cwiseQuotient(radii).norm();
          if (std::abs(r - 1) * radii.minCoeff() < 0.03) continue;
          inside += r < 1;
          ASSERT_EQ(labels[grid.index(i, j, k)], r < 1 ? kTibia : kNothing) << i << " " << j << " " << k;
        }
    EXPECT_GT(inside, 3000U);
  }
}

// A bone that runs out of the images on all sides fills them; one beside them leaves them as they are; one
// whose faces lie exactly on voxel centres is still whole.
TEST(BoneLabels, HoldAtTheImagesEdges) {
  images::Volume grid;
  grid.size = {10, 10, 10};
  Labels labels(1000, kNothing);
  add_bone(labels, grid, test::box(Vector3d(3, 3, 3), Vector3d(40, 5, 5)), kFemur);
  EXPECT_EQ(std::ranges::count(labels, kNothing), 1000);
  add_bone(labels, grid, test::box(Vector3d(3, 2, 1.5), Vector3d(5, 5, 5)), kFemur);
  const auto count = std::ranges::count(labels, kFemur);
  EXPECT_GE(count, 6 * 4 * 3);
  EXPECT_LE(count, 7 * 5 * 4);
  add_bone(labels, grid, test::box(Vector3d(30, 30, 30)), kTibia);
  EXPECT_EQ(std::ranges::count(labels, kTibia), 1000) << "the later bone takes what both hold";
}

TEST(BoneLabels, ADigestTellsOneChangedVoxelOfItsLabelAndNoOther) {
  Labels labels(1000, kNothing);
  std::fill(labels.begin() + 100, labels.begin() + 200, kFemur);
  const std::uint64_t before = digest_of(labels, kFemur);
  labels[500] = kTibia;
  EXPECT_EQ(digest_of(labels, kFemur), before);
  labels[150] = kTibia;
  EXPECT_NE(digest_of(labels, kFemur), before);
  labels[150] = kFemur;
  EXPECT_EQ(digest_of(labels, kFemur), before);
}

}  // namespace
}  // namespace arthronaut::painting
