#include "planning/images/bone_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/images/voxel_mask.h"
#include "tests/message_of.h"

namespace arthronaut::images {
namespace {

using test::message_of;
using testing::HasSubstr;

// A volume in an oblique, mirrored grid, filled by a function of the place in the patient.
template <typename ValueAt>
Volume sampled(const Eigen::Vector3d& spacing_mm, const Eigen::Vector3i& size, const ValueAt& value_at) {
  Volume volume;
  volume.size = size;
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
      Eigen::Vector3d(1, 1, -1).asDiagonal();
  volume.lps_from_index.linear() = turned * spacing_mm.asDiagonal();
  volume.lps_from_index.translation() =
      -(volume.lps_from_index.linear() * (0.5 * (size.cast<double>() - Eigen::Vector3d::Ones())));
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) {
        volume.values.push_back(
            static_cast<float>(value_at(volume.lps_from_index * Eigen::Vector3d(i, j, k))));
      }
    }
  }
  return volume;
}

const Eigen::Vector3d kRadii(30, 25, 35);

double ellipsoid_level(const Eigen::Vector3d& p) { return p.cwiseQuotient(kRadii).norm(); }

struct Error {
  double mean_mm = 0, worst_mm = 0;
};
// First-order distance of the vertices from the ellipsoid: exact enough within a millimetre.
Error error_of(const geometry::TriangleMesh& mesh) {
  Error error;
  for (const auto& p : mesh.vertices_mm) {
    const double level = ellipsoid_level(p);
    const double distance = std::abs((level - 1) * level / p.cwiseQuotient(kRadii.cwiseAbs2()).norm());
    error.mean_mm += distance / static_cast<double>(mesh.vertices_mm.size());
    error.worst_mm = std::max(error.worst_mm, distance);
  }
  return error;
}

// Of its label's surface, which is closed, in one piece, and as large as it.
Error error_of_labelled_ellipsoid(const Eigen::Vector3d& spacing_mm, const Eigen::Vector3i& size) {
  const Volume volume =
      sampled(spacing_mm, size, [](const auto& p) { return ellipsoid_level(p) < 1 ? 5 : 0; });
  const auto repair = bones::mend_mesh(surface_of_label(volume, 5).mesh);
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_EQ(repair.report.parts_found, 1U);
  const double true_mm3 = 4.0 / 3 * geometry::kPi * kRadii.prod();
  EXPECT_NEAR(repair.report.volume_mm3, true_mm3, 0.01 * true_mm3);
  return error_of(repair.mesh);
}

// A label's surface in an oblique grid lies where the label is in the patient, to a fraction of a voxel.
TEST(BoneSurface, OfALabelInAnObliqueGrid) {
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(0.8, 0.8, 0.8), Eigen::Vector3d(0.8, 0.8, 2.0)}) {
    const Eigen::Vector3i size = (Eigen::Vector3d(110, 110, 110).cwiseQuotient(spacing)).cast<int>();
    const Error error = error_of_labelled_ellipsoid(spacing, size);
    EXPECT_LT(error.mean_mm, 0.15 * spacing.maxCoeff());
    EXPECT_LT(error.worst_mm, 0.6 * spacing.maxCoeff());
  }
}

// Slices of 4 mm, as of most MRs of knees: between them the surface goes over evenly instead of in steps of a
// slice, whichever axis of the grid they lie across. Where the shape ends between two slices nothing tells
// where: half a slice is the most that it can be off there.
TEST(BoneSurface, OfThickSlicesGoesOverFromOneToTheNext) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d spacing(0.5, 0.5, 0.5);
    spacing[axis] = 4;
    const Eigen::Vector3i size = (Eigen::Vector3d(90, 90, 90).cwiseQuotient(spacing)).cast<int>();
    SCOPED_TRACE(axis);
    const Error error = error_of_labelled_ellipsoid(spacing, size);
    EXPECT_LT(error.mean_mm, 0.05 * spacing[axis]);
    EXPECT_LT(error.worst_mm, 0.5 * spacing[axis]);
  }
}

// A shaft that runs out of the scan at both ends is closed there.
TEST(BoneSurface, ABoneThatLeavesTheVolumeIsCapped) {
  Volume volume = sampled({1, 1, 1}, {60, 60, 40}, [](const auto&) { return 0; });
  volume.lps_from_index.linear() = Eigen::Matrix3d::Identity();
  volume.lps_from_index.translation().setZero();
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i)
        volume.values[volume.index(i, j, k)] = std::hypot(i - 30, j - 30) < 15 ? 1 : 0;
    }
  }
  const auto repair = bones::mend_mesh(surface_of_label(volume, 1).mesh);
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_EQ(repair.report.holes_filled, 0U);
  const double true_mm3 = geometry::kPi * 15 * 15 * 40;
  EXPECT_NEAR(repair.report.volume_mm3, true_mm3, 0.04 * true_mm3);
}

TEST(BoneSurface, WhatIsNotThereIsRefused) {
  const Volume labels = sampled({1, 1, 1}, {20, 20, 20}, [](const auto& p) { return p.norm() < 5 ? 3 : 0; });
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)surface_of_label(labels, 5); }), HasSubstr("0, 3"));
  const Volume grey = sampled({1, 1, 1}, {20, 20, 20}, [](const auto& p) { return p.norm(); });
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)surface_of_label(grey, 5); }), HasSubstr("no label map"));
}

// Against every voxel pair, in a grid with three spacings.
TEST(VoxelMask, DistancesAreThoseOfTheNearestVoxel) {
  const Eigen::Vector3i size(9, 7, 5);
  const Eigen::Vector3d spacing(0.7, 1.1, 3.0);
  const std::vector<std::size_t> voxels{3, 100, 101, 250};
  const auto found = distances_mm(size, voxels, spacing);
  const auto place = [&](std::size_t v) {
    return Eigen::Vector3d(static_cast<double>(v % 9), static_cast<double>(v / 9 % 7),
                           static_cast<double>(v / 63))
        .cwiseProduct(spacing)
        .eval();
  };
  for (std::size_t v = 0; v < found.size(); ++v) {
    double least = 1e9;
    for (const std::size_t other : voxels) least = std::min(least, (place(v) - place(other)).norm());
    EXPECT_NEAR(found[v], least, 1e-4);
  }
}

}  // namespace
}  // namespace arthronaut::images
