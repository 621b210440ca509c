// Bones of a CT whose bones are known: where the surface comes out, that it is closed, and what is told
// apart.
#include "planning/segmentation/ct_bones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/segmentation/anatomy_check.h"
#include "tests/message_of.h"
#include "tests/planning/segmentation/known_bones.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut::segmentation {
namespace {

using bones::BoneKind;
using geometry::TriangleMesh;
using testing::HasSubstr;

using test::fibula_of;
using test::knee;

// Both bones at once, between voxels: what was asked for is a median of 0.12 mm and 0.35 mm for 95 %. The
// flat ends, a twentieth of each bone, lie where a layer of voxels is about as bright as the threshold.
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
        EXPECT_LT(distances[distances.size() * 99 / 100], 0.35);
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

// A narrow joint: no threshold parts them, and each surface still lies at its edge, not at the cut.
TEST(CtBones, BonesThatTouchPartAtTheirEdges) {
  auto truth = knee();
  for (auto& p : truth[1].vertices_mm) p.z() += 1.7;  // 0.5 mm are left between them
  test::KnownCtOptions options;
  options.blur_mm = 0.5;
  const CtBones found = bones_of_ct(test::known_ct(truth, options));
  ASSERT_EQ(found.bones.size(), 2U);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("parted along the joint space")));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto mended = bones::mend_mesh(found.bones[i].mesh);
    EXPECT_TRUE(mended.report.is_closed);
    const auto distances = test::distances_to(truth[i], mended.mesh, 0);
    EXPECT_LT(distances[distances.size() / 2], 0.12) << i;
    EXPECT_LT(distances[distances.size() * 95 / 100], 0.35) << i;
  }
}

// Where they press on each other there is no edge, and neither loses its plate and its marrow to the other.
TEST(CtBones, BonesThatPressOnEachOtherKeepTheirMarrow) {
  auto truth = knee();
  for (auto& p : truth[1].vertices_mm) p.z() += 3;
  test::KnownCtOptions options;
  options.spacing_mm = {0.6, 0.6, 0.8};
  options.blur_mm = 0.5;
  const CtBones found = bones_of_ct(test::known_ct(truth, options));
  ASSERT_EQ(found.bones.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const double truth_mm3 = geometry::signed_volume_mm3(truth[i]);
    EXPECT_NEAR(std::abs(geometry::signed_volume_mm3(bones::mend_mesh(found.bones[i].mesh).mesh)), truth_mm3,
                0.03 * truth_mm3);
  }
}

// Where none is seen that is said: it may be in the bone.
TEST(CtBones, AFibulaThatIsNotSeenIsSaid) {
  test::KnownCtOptions options;
  options.spacing_mm = {0.8, 0.8, 1.0};
  const CtBones found = bones_of_ct(test::known_ct(knee(), options));
  ASSERT_EQ(found.bones.size(), 2U);
  EXPECT_THAT(found.bones[1].notes, testing::Contains(HasSubstr("no fibula is seen")));
  EXPECT_THAT(found.bones[0].notes, testing::Not(testing::Contains(HasSubstr("fibula"))));
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

// The knee's femur alone in a small field of view: it ends in front within the shaft, and above.
struct CutFemur {
  images::Volume volume;
  double front_mm = 0, top_mm = 0;  // LPS y and z
};
CutFemur cut_femur(const std::function<void(images::Volume&)>& operate) {
  const TriangleMesh& truth = knee()[0];
  test::KnownCtOptions options;
  options.spacing_mm = {0.8, 0.8, 1.0};
  options.highest_mm = geometry::bounds_of(truth).max_mm.z() - 15;
  options.operate = operate;
  const images::Volume whole = test::known_ct({truth}, options);
  CutFemur cut{whole, 0, options.highest_mm};
  double count = 0;
  for (const Eigen::Vector3d& p : truth.vertices_mm) {
    if (p.z() < options.highest_mm - 10 || p.z() > options.highest_mm) continue;
    cut.front_mm += p.y();
    count += 1;
  }
  cut.front_mm /= count;
  const int first =
      static_cast<int>((whole.lps_from_index.inverse() * Eigen::Vector3d(0, cut.front_mm, 0)).y());
  cut.volume.size.y() -= first;
  cut.volume.lps_from_index.translate(Eigen::Vector3d(0, first, 0));
  cut.volume.values.clear();
  for (int k = 0; k < whole.size.z(); ++k)
    for (int j = first; j < whole.size.y(); ++j)
      for (int i = 0; i < whole.size.x(); ++i) cut.volume.values.push_back(whole.at(i, j, k));
  return cut;
}

// The share of the surface's vertices, away from the ends, that do not lie on the femur's outside, nor within
// so much of any of these points.
double within_cortex(const CutFemur& cut, const CtBones& found, const std::vector<Eigen::Vector3d>& gaps_mm,
                     double gap_radius_mm) {
  const geometry::Surface surface(bones::mend_mesh(found.bones[0].mesh).mesh), exact(knee()[0]);
  int within = 0;
  for (const Eigen::Vector3d& p : surface.mesh().vertices_mm) {
    const bool is_at_an_end = p.y() < cut.front_mm + 2 || p.z() > cut.top_mm - 3;
    const bool is_at_a_gap = std::ranges::any_of(
        gaps_mm, [&](const Eigen::Vector3d& gap) { return (p - gap).norm() < gap_radius_mm + 2; });
    within += !is_at_an_end && !is_at_a_gap && (exact.closest_point(p).point_mm - p).norm() > 0.8;
  }
  return within / static_cast<double>(surface.mesh().vertices_mm.size());
}

// Its marrow is open to both ends of the volume at once, enclosed within neither.
// Marrow is darker than the cortex about it in many places: that is no joint, and a whole bone stays whole.
TEST(CtBones, OneBoneAloneIsNotPartedThroughItsMarrow) {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  for (const auto* bone : {&knee.femur, &knee.tibia}) {
    test::KnownCtOptions options;
    options.spacing_mm = {0.6, 0.6, 1};
    options.cortex_mm = 1.8;
    options.cortex_hu = 1100;
    options.marrow_hu = 280;
    options.blur_mm = 0.4;
    const CtBones found = bones_of_ct(test::known_ct({bone->mesh}, options), {});
    ASSERT_EQ(found.bones.size(), 1U);
    EXPECT_EQ(found.bones.front().kind, bone->kind);
    for (const std::string& note : found.notes) EXPECT_EQ(note.find("parted"), std::string::npos) << note;
  }
}

TEST(CtBones, MarrowThatTwoEndsOfTheVolumeOpenIsClosedOff) {
  const CutFemur cut = cut_femur(nullptr);
  const CtBones found = bones_of_ct(cut.volume);
  ASSERT_EQ(found.bones.size(), 1U);
  EXPECT_LT(within_cortex(cut, found, {}, 0), 0.01) << "on the cortex's inner face";
  EXPECT_THAT(found.bones[0].notes, testing::Not(testing::Contains(HasSubstr("gap"))));
}

// Where the cortex is soft or thin it is below the threshold: through gaps of 9 mm, more than is closed of
// itself, the outside would come in, and the inner face of the cortex were the bone's surface.
TEST(CtBones, MarrowBehindGapsOfTheCortexIsClosedOff) {
  constexpr double kGap_mm = 4.5;
  const TriangleMesh& truth = knee()[0];
  const geometry::Bounds bounds = geometry::bounds_of(truth);
  std::vector<Eigen::Vector3d> gaps_mm;  // on the inner and the outer condyle
  for (const double x : {bounds.min_mm.x(), bounds.max_mm.x()})
    gaps_mm.push_back(
        geometry::Surface(truth).closest_point({x, bounds.center_mm().y(), bounds.min_mm.z() + 25}).point_mm);
  const CutFemur cut = cut_femur([&](images::Volume& volume) {
    for (int k = 0; k < volume.size.z(); ++k)
      for (int j = 0; j < volume.size.y(); ++j)
        for (int i = 0; i < volume.size.x(); ++i) {
          const Eigen::Vector3d p = volume.lps_from_index * Eigen::Vector3d(i, j, k);
          float& hu = volume.values[volume.index(i, j, k)];
          for (const Eigen::Vector3d& gap : gaps_mm)
            if ((p - gap).norm() < kGap_mm) hu = std::min(hu, 150.0F);
        }
  });
  const CtBones found = bones_of_ct(cut.volume);
  ASSERT_EQ(found.bones.size(), 1U);
  EXPECT_LT(within_cortex(cut, found, gaps_mm, kGap_mm), 0.01) << "on the cortex's inner face";
  EXPECT_THAT(found.bones[0].notes, testing::Contains(HasSubstr("gaps of up to")));
  for (const Eigen::Vector3d& gap : gaps_mm)
    EXPECT_LT((geometry::Surface(found.bones[0].mesh).closest_point(gap).point_mm - gap).norm(), 3)
        << "the bone goes on across the gap";
}

// A rail of the table is as slender as a fibula and may run beside the bone: it says nothing on the side.
TEST(CtBones, ARailOfTheTableIsNoFibula) {
  test::KnownCtOptions options;
  options.spacing_mm = {1.2, 1.2, 1.5};
  TriangleMesh rail = fibula_of(knee()[1]);
  for (Eigen::Vector3d& p : rail.vertices_mm) p.y() += 70;
  options.cortex_mm = 4;
  const CtBones found = bones_of_ct(test::known_ct({knee()[0], knee()[1], rail}, options));
  ASSERT_EQ(found.bones.size(), 2U);
  EXPECT_FALSE(found.side_by_fibula.has_value());
  EXPECT_FALSE(found.is_one_of_both);
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
  const CtBones found = bones_of_ct(volume, asked);
  EXPECT_TRUE(found.is_one_of_both) << "where it lies bears out what was asked for";
  for (const CtBone& bone : found.bones) EXPECT_GT(geometry::bounds_of(bone.mesh).min_mm.x(), 80);
}

// What lies between two knees, as a hand or a support, is part of neither: each side gives the outermost.
TEST(CtBones, WhatLiesBetweenTwoKneesIsOfNeither) {
  auto two = knee();
  for (auto mesh : knee()) {
    for (auto& p : mesh.vertices_mm) p.x() += 220;
    two.push_back(mesh);
  }
  test::KnownCtOptions options;
  options.spacing_mm = {1.2, 1.2, 1.2};
  options.samples = 1;
  options.operate = [](images::Volume& volume) {
    for (int k = 0; k < volume.size.z(); ++k)
      for (int j = 0; j < volume.size.y(); ++j)
        for (int i = 0; i < volume.size.x(); ++i) {
          const Eigen::Vector3d p = volume.lps_from_index * Eigen::Vector3d(i, j, k);
          if (std::abs(p.x() - 110) < 25 && std::abs(p.y()) < 25 && p.z() > 20 && p.z() < 75)
            volume.values[volume.index(i, j, k)] = 500;
        }
  };
  const images::Volume volume = test::known_ct(two, options);
  for (const bones::Side side : {bones::Side::Right, bones::Side::Left}) {
    CtBonesOptions asked;
    asked.side = side;
    const CtBones found = bones_of_ct(volume, asked);
    ASSERT_EQ(found.bones.size(), 2U);
    for (const CtBone& bone : found.bones)
      EXPECT_NEAR(geometry::bounds_of(bone.mesh).center_mm().x(), side == bones::Side::Right ? 0 : 220, 15)
          << bones::to_text(bone.kind) << " of the " << bones::to_text(side) << " knee";
    EXPECT_THAT(found.notes, testing::Contains(HasSubstr("farthest on the patient's " +
                                                         std::string(bones::to_text(side)))));
  }
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
