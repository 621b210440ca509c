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
using testing::Not;

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

// A ball that hangs by a stalk on the tibia's inner side, as an osteochondroma does. LPS, a right knee.
struct Outgrowth {
  Eigen::Vector3d foot_mm;
  double radius_mm;
  void operator()(images::Volume& volume) const {
    constexpr double kStalk_mm = 2.6, kShell_mm = 1.5;
    const Eigen::Vector3d center = foot_mm + Eigen::Vector3d(radius_mm + 3, 0, 0);
    for (int k = 0; k < volume.size.z(); ++k)
      for (int j = 0; j < volume.size.y(); ++j)
        for (int i = 0; i < volume.size.x(); ++i) {
          const Eigen::Vector3d p = volume.lps_from_index * Eigen::Vector3d(i, j, k);
          const double off_mm = (p - center).norm();
          const bool is_stalk =
              p.x() > foot_mm.x() - 4 && p.x() < center.x() && (p - center).tail<2>().norm() < kStalk_mm;
          if (off_mm > radius_mm && !is_stalk) continue;
          float& hu = volume.values[volume.index(i, j, k)];
          hu = std::max(hu, off_mm < radius_mm - kShell_mm ? 400.0F : 1100.0F);
        }
  }
};
Outgrowth medial_outgrowth(double radius_mm) {
  const TriangleMesh& tibia = test::knee()[1];
  const geometry::Bounds bounds = geometry::bounds_of(tibia);
  Outgrowth outgrowth{bounds.min_mm, radius_mm};
  for (const Eigen::Vector3d& p : tibia.vertices_mm)
    if (std::abs(p.z() - (bounds.max_mm.z() - 22)) < 2 && p.x() > outgrowth.foot_mm.x())
      outgrowth.foot_mm = p;
  return outgrowth;
}

// What hangs on the tibia's inner side does not outvote the fibula that stands free on the other, and is not
// called one: the other side's landmarks and tunnels would follow.
TEST(Fibula, Hazard52AnOutgrowthIsNoFibula) {
  const TriangleMesh& tibia = test::knee()[1];
  TriangleMesh fibula = test::fibula_of(tibia);  // to the right, where it is in a right knee
  const geometry::Bounds bounds = geometry::bounds_of(tibia);
  for (Eigen::Vector3d& p : fibula.vertices_mm) p.x() += bounds.min_mm.x() - bounds.max_mm.x() - 20;
  for (const double radius_mm : {9.0, 12.0}) {
    for (const bool has_fibula : {true, false}) {
      SCOPED_TRACE(radius_mm);
      test::KnownCtOptions options;
      options.spacing_mm = {0.8, 0.8, 1.0};
      options.margin_mm = 14;
      options.operate = medial_outgrowth(radius_mm);
      std::vector<TriangleMesh> bones = test::knee();
      if (has_fibula) bones.push_back(fibula);
      const CtBones found = bones_of_ct(test::known_ct(bones, options));
      ASSERT_EQ(found.bones.size(), 2U);
      EXPECT_NE(found.side_by_fibula, Side::Left) << has_fibula;
      EXPECT_THAT(found.bones[1].notes, Not(Contains(HasSubstr("the fibula, which touches"))));
    }
  }
}

}  // namespace
}  // namespace arthronaut::segmentation
