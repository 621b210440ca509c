// Bones of a CT whose bones are known: where the surface comes out, that it is closed, and what is told
// apart.
#include "planning/segmentation/ct_bones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/segmentation/anatomy_check.h"
#include "tests/message_of.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut::segmentation {
namespace {

using bones::BoneKind;
using geometry::TriangleMesh;
using testing::HasSubstr;

const std::vector<TriangleMesh>& knee() {
  static const auto phantom = phantom::make_phantom_knee();
  static const std::vector<TriangleMesh> meshes{phantom.femur.mesh, phantom.tibia.mesh};
  return meshes;
}

// A rod beside the tibia, on the patient's left.
TriangleMesh fibula_of(const TriangleMesh& tibia) {
  TriangleMesh rod;
  const geometry::Bounds bounds = geometry::bounds_of(tibia);
  constexpr int kSides = 24;
  const Eigen::Vector3d foot(bounds.max_mm.x() + 10, bounds.center_mm().y(), bounds.min_mm.z() + 1);
  const double height = bounds.size_mm().z() - 14;
  for (const double z : {0.0, height}) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * M_PI * i / kSides;
      rod.vertices_mm.push_back(foot + Eigen::Vector3d(6 * std::cos(angle), 6 * std::sin(angle), z));
    }
    rod.vertices_mm.push_back(foot + Eigen::Vector3d(0, 0, z));
  }
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides, above = kSides + 1;
    rod.triangles.push_back({i, next, above + i});
    rod.triangles.push_back({next, above + next, above + i});
    rod.triangles.push_back({kSides, next, i});
    rod.triangles.push_back({above + kSides, above + i, above + next});
  }
  return rod;
}

// Both bones at once, between voxels: what was asked for is a median of 0.12 mm and 0.35 mm for 95 %.
TEST(CtBones, SurfacesLieAtTheEdgeOfKnownBones) {
  const auto truth = knee();
  for (const double blur_mm : {0.35, 0.5}) {
    test::KnownCtOptions options;
    options.blur_mm = blur_mm;
    const CtBones found = bones_of_ct(test::known_ct(truth, options));
    ASSERT_EQ(found.bones.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(found.bones[i].kind, i == 0 ? BoneKind::Femur : BoneKind::Tibia);
      EXPECT_TRUE(found.bones[i].doubts.empty());
      const auto mended = bones::mend_mesh(found.bones[i].mesh);
      EXPECT_TRUE(mended.report.is_closed);
      const auto out = test::distances_to(truth[i], mended.mesh, 0),
                 back = test::distances_to(mended.mesh, truth[i], 0);
      for (const auto& distances : {out, back}) {
        EXPECT_LT(distances[distances.size() / 2], 0.12);
        EXPECT_LT(distances[distances.size() * 95 / 100], 0.35);
      }
      EXPECT_TRUE(anatomy_doubts(mended.mesh, found.bones[i].kind).empty());
    }
  }
}

// A knee lies on the table as it can. Its plateau then reaches far above the largest level section of the
// tibia, which is a whole bone all the same: nothing of it is cut off along the joint.
TEST(CtBones, AKneeThatLeansKeepsItsPlateau) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitY().eval()}) {
    auto truth = knee();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(geometry::rad_from_deg(25), axis).toRotationMatrix();
    for (TriangleMesh& mesh : truth)
      for (Eigen::Vector3d& vertex : mesh.vertices_mm) vertex = turn * vertex;
    const CtBones found = bones_of_ct(test::known_ct(truth));
    ASSERT_EQ(found.bones.size(), 2U);
    EXPECT_TRUE(found.notes.empty()) << found.notes.front();
    for (std::size_t i = 0; i < 2; ++i) {
      const auto distances = test::distances_to(found.bones[i].mesh, truth[i], 0);
      EXPECT_LT(distances[distances.size() * 95 / 100], 0.35);
      EXPECT_LT(distances.back(), 1.5) << "a plateau that is cut off is 4 to 11 mm short";
    }
  }
}

// In slices of 3 mm the joint space is gone in places: the bones are parted along what is left of it, and the
// fibula says which knee it is.
TEST(CtBones, BonesThatTouchInThickSlicesArePartedAtTheJoint) {
  auto truth = knee();
  // Brought together until what is between them is thinner than a slice.
  const double gap = geometry::bounds_of(truth[0]).min_mm.z() - geometry::bounds_of(truth[1]).max_mm.z();
  for (auto& p : truth[0].vertices_mm) p.z() -= gap + 5.0;
  truth.push_back(fibula_of(truth[1]));
  test::KnownCtOptions options;
  options.spacing_mm = {0.98, 0.98, 3.27};
  options.blur_mm = 0.6;
  options.samples = 5;
  const CtBones found = bones_of_ct(test::known_ct(truth, options));
  ASSERT_EQ(found.bones.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto mended = bones::mend_mesh(found.bones[i].mesh);
    EXPECT_TRUE(anatomy_doubts(mended.mesh, found.bones[i].kind).empty());
    // The cut follows the joint to a slice, as the sheet's plates are seen in one slice or the next; the rest
    // of the surface lies between the slices.
    for (const auto& distances :
         {test::distances_to(truth[i], mended.mesh, 0), test::distances_to(mended.mesh, truth[i], 0)}) {
      EXPECT_LT(distances[distances.size() / 2], 0.5) << i;
      EXPECT_LT(distances[distances.size() * 95 / 100], 3.27) << i;
    }
  }
  EXPECT_EQ(found.side_by_fibula, bones::Side::Left);
}

TEST(CtBones, OneBoneAloneIsWhatItIs) {
  test::KnownCtOptions options;
  options.spacing_mm = {0.8, 0.8, 1.0};
  const CtBones femur = bones_of_ct(test::known_ct({knee()[0]}, options)),
                tibia = bones_of_ct(test::known_ct({knee()[1]}, options));
  ASSERT_EQ(femur.bones.size(), 1U);
  EXPECT_EQ(femur.bones[0].kind, BoneKind::Femur);
  ASSERT_EQ(tibia.bones.size(), 1U);
  EXPECT_EQ(tibia.bones[0].kind, BoneKind::Tibia);
  EXPECT_FALSE(tibia.side_by_fibula.has_value());
}

// As in a scan that begins within the condyles: what is there of a femur is no femur to plan on.
TEST(CtBones, TheEndOfAFemurIsDoubted) {
  const auto truth = knee();
  test::KnownCtOptions options;
  options.spacing_mm = {0.8, 0.8, 1.0};
  options.highest_mm = geometry::bounds_of(truth[0]).min_mm.z() + 20;
  const CtBones found = bones_of_ct(test::known_ct(truth, options));
  for (const CtBone& bone : found.bones) {
    const auto doubts = anatomy_doubts(bones::mend_mesh(bone.mesh).mesh, bone.kind);
    EXPECT_EQ(doubts.empty(), bone.kind == BoneKind::Tibia);
  }
}

TEST(CtBones, BothKneesAreAskedAbout) {
  auto two = knee();
  for (auto mesh : knee()) {
    for (auto& p : mesh.vertices_mm) p.x() += 160;
    two.push_back(mesh);
  }
  test::KnownCtOptions options;
  options.spacing_mm = {1.0, 1.0, 1.0};
  const images::Volume volume = test::known_ct(two, options);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)bones_of_ct(volume); }), HasSubstr("--side"));
  CtBonesOptions asked;
  asked.side = bones::Side::Left;
  for (const CtBone& bone : bones_of_ct(volume, asked).bones)
    EXPECT_GT(geometry::bounds_of(bone.mesh).min_mm.x(), 80);
}

TEST(CtBones, NothingAboveTheThresholdIsSaid) {
  test::KnownCtOptions coarse;
  coarse.spacing_mm = {2, 2, 2};
  const images::Volume volume = test::known_ct({knee()[1]}, coarse);
  CtBonesOptions options;
  options.threshold = 3000;
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)bones_of_ct(volume, options); }),
              HasSubstr("no femur and no tibia above the threshold of 3000 HU"));
}

}  // namespace
}  // namespace arthronaut::segmentation
