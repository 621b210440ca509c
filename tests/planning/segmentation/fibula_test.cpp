// The fibula in a CT whose bones are known: taken off where it touches, and which side it tells.
#include "planning/segmentation/fibula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/segmentation/ct_bones.h"
#include "tests/planning/segmentation/known_bones.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut::segmentation {
namespace {

using bones::Side;
using geometry::TriangleMesh;
using testing::Contains;
using testing::HasSubstr;

// However broadly it touches, the fibula is no part of the tibia, and tells the side.
TEST(Fibula, AFibulaThatTouchesBroadlyIsTakenOff) {
  const TriangleMesh &femur = test::knee()[0], &tibia = test::knee()[1];
  const TriangleMesh fibula = test::fibula_against(tibia);
  ASSERT_GT(geometry::signed_volume_mm3(fibula), 8'000);
  for (const double slice_mm : {0.625, 1.25}) {
    test::KnownCtOptions options;
    options.spacing_mm = {0.5, 0.5, slice_mm};
    const CtBones found = bones_of_ct(test::known_ct({femur, tibia, fibula}, options));
    ASSERT_EQ(found.bones.size(), 2U);
    EXPECT_EQ(found.side_by_fibula, bones::Side::Left) << slice_mm;
    const CtBone& made = found.bones[1];
    EXPECT_TRUE(made.doubts.empty());
    EXPECT_THAT(made.notes, testing::Contains(HasSubstr("fibula, which touches, was taken off")));
    const auto mended = bones::mend_mesh(made.mesh);
    // The fibula reaches 24 mm further than the tibia, and has an eighth of its volume.
    const auto distances = test::distances_to(tibia, mended.mesh, 0);
    EXPECT_LT(distances[distances.size() / 2], 0.12) << slice_mm;
    EXPECT_LT(distances[distances.size() * 95 / 100], std::max(0.35, slice_mm / 2)) << slice_mm;
    EXPECT_LT(distances.back(), 3.2) << "a stub of it stays, which is less than three slices of 1.25 mm deep";
    const double truth_mm3 = geometry::signed_volume_mm3(tibia);
    EXPECT_NEAR(std::abs(geometry::signed_volume_mm3(mended.mesh)), truth_mm3, 0.015 * truth_mm3) << slice_mm;
    // What is said of the volume is said of the tibia alone.
    EXPECT_THAT(made.notes.front(), HasSubstr(std::to_string(std::lround(truth_mm3 / 1000)).substr(0, 2)));
  }
}

// Slices of 2 mm from side to side, upright and leaning by 20 degrees: the axis of the volume along which the
// bone runs is the one that is nearest to the patient's up, however fine its steps are.
TEST(Fibula, ThatTouchesIsTakenOffInThickSlicesThatLean) {
  const TriangleMesh& tibia = test::knee()[1];
  const TriangleMesh fibula = test::fibula_against(tibia);
  for (const double lean_deg : {0.0, 20.0}) {
    SCOPED_TRACE(lean_deg);
    std::vector<TriangleMesh> in_scan{test::knee()[0], tibia, fibula};
    const Eigen::Matrix3d lps_from_scan =
        Eigen::AngleAxisd(geometry::rad_from_deg(lean_deg), Eigen::Vector3d::UnitY()).toRotationMatrix();
    for (TriangleMesh& mesh : in_scan)
      for (Eigen::Vector3d& p : mesh.vertices_mm) p = lps_from_scan.transpose() * p;
    test::KnownCtOptions options;
    options.spacing_mm = {2, 0.6, 0.6};
    images::Volume volume = test::known_ct(in_scan, options);
    volume.lps_from_index = Eigen::Affine3d(lps_from_scan) * volume.lps_from_index;
    const CtBones found = bones_of_ct(volume);
    ASSERT_EQ(found.bones.size(), 2U);
    EXPECT_EQ(found.side_by_fibula, Side::Left);
    const auto distances = test::distances_to(tibia, bones::mend_mesh(found.bones[1].mesh).mesh, 8);
    EXPECT_LT(distances[distances.size() / 2], 0.4);
    EXPECT_LT(distances[distances.size() * 95 / 100], 1.5) << "less than a slice";
    EXPECT_LT(distances.back(), 8) << "a stub of it stays, four slices deep at most";
  }
}

}  // namespace
}  // namespace arthronaut::segmentation
