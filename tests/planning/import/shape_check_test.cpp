#include "planning/import/shape_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "planning/import/import_side.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::importing {
namespace {

using bones::Side;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// The built-in right knee as an import, or its mirror image, which is a left one.
BoneImport knee(Side side, std::optional<Side> said) {
  static const auto phantom = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  BoneImport import;
  import.side = said;
  if (said) import.side_source = SideSource::Person;
  for (const bones::Bone& bone : {phantom.femur, phantom.tibia}) {
    import.bones.emplace_back().bone = bone;
    if (side == Side::Right) continue;
    for (auto& p : import.bones.back().bone.mesh.vertices_mm) p.x() = -p.x();
    for (auto& t : import.bones.back().bone.mesh.triangles) std::swap(t[0], t[1]);
  }
  return import;
}

std::vector<std::string> doubts_of(const BoneImport& import) {
  std::vector<std::string> all;
  for (const auto& bone : import.bones)
    for (const auto& doubt : doubts_with(import, bone, import.side)) all.push_back(words_of(doubt));
  return all;
}

TEST(ShapeCheck, SaysNothingOfAKneeThatIsWhatItIsSaidToBe) {
  for (const Side side : {Side::Left, Side::Right}) {
    BoneImport import = knee(side, side);
    check_shapes(import, false);
    EXPECT_THAT(doubts_of(import), IsEmpty());
    EXPECT_EQ(import.side_source, SideSource::Person);
  }
}

// Half a turn about the long axis is all that RAS read as LPS does: no mirror, no other side.
TEST(ShapeCheck, FrontsThatLookBackwardsRaiseADoubtOfEachBone) {
  BoneImport import = knee(Side::Right, Side::Right);
  for (auto& bone : import.bones)
    for (auto& p : bone.bone.mesh.vertices_mm) p.head<2>() = -p.head<2>();
  check_shapes(import, false);
  for (const auto& bone : import.bones) {
    EXPECT_THAT(bone.doubts, Contains(HasSubstr("LPS and RAS")));
    EXPECT_TRUE(bone.looks_backwards);
  }
}

// The bones of one file are turned together: of one alone it is the shape that misleads.
TEST(ShapeCheck, OneFrontOfTwoThatLooksBackwardsRaisesNone) {
  BoneImport import = knee(Side::Right, Side::Right);
  for (auto& p : import.bones.back().bone.mesh.vertices_mm) p.head<2>() = -p.head<2>();
  check_shapes(import, true);
  EXPECT_THAT(doubts_of(import), IsEmpty());
}

// A foot that falls outwards as far as it can is no other convention.
TEST(ShapeCheck, AKneeThatIsTurnedInTheScannerRaisesNone) {
  BoneImport import = knee(Side::Right, Side::Right);
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (auto& bone : import.bones)
    for (auto& p : bone.bone.mesh.vertices_mm) p = turned * p;
  check_shapes(import, false);
  EXPECT_THAT(doubts_of(import), IsEmpty());
}

// What an import says of the bone.
std::vector<std::string> said_of(const bones::Bone& bone) {
  auto doubts = shape_doubts(bone.mesh, bone.kind, {});
  if (!doubts.empty()) return doubts;
  BoneImport import;
  import.side = Side::Right;
  import.side_source = SideSource::Person;
  import.bones.emplace_back().bone = bone;
  check_shapes(import, true);
  return import.bones.front().doubts;
}

bones::Bone turned(bones::Bone bone, const Eigen::Matrix3d& rotation) {
  for (auto& p : bone.mesh.vertices_mm) p = rotation * p;
  return bone;
}

// A file with other axes turns its bones by any rotation: of either bone the axes are told, and never that it
// is another bone or in order. A bone that leans as legs do in a scanner is in order.
TEST(ShapeCheck, ABoneThatLiesIsSaidToLieHoweverItIsTurned) {
  const auto phantom = phantom::make_phantom_knee({.edge_length_mm = 2.5});
  // The built-in knee's shafts stand within 10 degrees of upright; beyond that, 60 degrees of lean are told.
  constexpr double kMustBeTold_deg = 72, kMayLean_deg = 35;
  std::mt19937 random(20261128);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  std::vector<Eigen::Matrix3d> lying{
      Eigen::AngleAxisd(135 * EIGEN_PI / 180, Eigen::Vector3d::Ones().normalized()).toRotationMatrix()};
  while (lying.size() < 5) {
    const Eigen::Matrix3d rotation =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .toRotationMatrix();
    if (rotation(2, 2) < std::cos(kMustBeTold_deg * EIGEN_PI / 180)) lying.push_back(rotation);
  }
  for (const bones::Bone& bone : {phantom.femur, phantom.tibia}) {
    for (const Eigen::Matrix3d& rotation : lying)
      EXPECT_THAT(said_of(turned(bone, rotation)), ElementsAre(HasSubstr("the axes of the file")))
          << bones::to_text(bone.kind) << "\n"
          << rotation;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d axis = any().cross(Eigen::Vector3d::UnitZ()).normalized();
      EXPECT_THAT(
          said_of(turned(bone, Eigen::AngleAxisd(kMayLean_deg * EIGEN_PI / 180, axis).toRotationMatrix())),
          IsEmpty())
          << bones::to_text(bone.kind) << " about " << axis.transpose();
    }
  }
  EXPECT_THAT(said_of(turned(phantom.femur,
                             Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX()).toRotationMatrix())),
              ElementsAre(HasSubstr("its shaft points down, not up")));
}

TEST(ShapeCheck, ASideThatBothBonesContradictRaisesADoubt) {
  BoneImport import = knee(Side::Left, Side::Right);
  check_shapes(import, false);
  EXPECT_EQ(import.side, Side::Right);  // what a person said stands
  EXPECT_THAT(doubts_of(import),
              AllOf(SizeIs(2), Each(AllOf(HasSubstr("left knee"), HasSubstr("check the side")))))
      << "of either bone: one may be made anew, or be asked of alone";
}

// A bone alone does not tell which knee it is of; but what its shape tells is held against what is said
// later, and taken back with it.
TEST(ShapeCheck, WhatABoneAloneTellsIsHeldAgainstTheSideThatIsSaidLater) {
  BoneImport import = knee(Side::Left, std::nullopt);
  import.bones.pop_back();
  check_shapes(import, false);
  EXPECT_EQ(import.side, std::nullopt);
  ASSERT_EQ(side_by_shapes(import), Side::Left) << "else nothing is held against anything";
  say_side(import, Side::Right);
  EXPECT_TRUE(side_is_contradicted(import));
  EXPECT_THAT(doubts_of(import), ElementsAre(AllOf(HasSubstr("by the shape of the bone it is a left knee"),
                                                   HasSubstr("the side is right"))));
  say_side(import, Side::Left);
  EXPECT_FALSE(side_is_contradicted(import));
  EXPECT_THAT(doubts_of(import), IsEmpty());
}

// Where the shapes alone told the side, a person who says the same one has checked it: nothing is left to be
// checked.
TEST(ShapeCheck, APersonWhoConfirmsWhatTheShapesToldLeavesNoDoubt) {
  BoneImport import = knee(Side::Left, std::nullopt);
  check_shapes(import, false);
  ASSERT_EQ(import.side, Side::Left);
  ASSERT_THAT(doubts_of(import), AllOf(SizeIs(2), Each(HasSubstr("told by the shape of its bones alone"))));
  EXPECT_THAT(doubts_with(import, import.bones.front(), Side::Left), ElementsAre(testing::_))
      << "a case's side alone confirms nothing";
  EXPECT_THAT(doubts_with(import, import.bones.front(), Side::Left, true), IsEmpty());
  say_side(import, Side::Left);
  EXPECT_THAT(doubts_of(import), IsEmpty());
  EXPECT_EQ(import.side_source, SideSource::Person);
}

// Two bones from files of their own, of which one alone says the side.
TEST(ShapeCheck, ASecondFileHearsOfTheFirstOnesSide) {
  BoneImport femur = knee(Side::Left, std::nullopt), tibia = femur;
  femur.bones.pop_back();
  tibia.bones.erase(tibia.bones.begin());
  femur.side = Side::Right;
  femur.side_source = SideSource::SourceName;
  check_shapes(tibia, false);
  BoneImport both = femur;
  ASSERT_TRUE(add_bones(both, tibia));
  EXPECT_EQ(both.bones.size(), 2U);
  EXPECT_EQ(both.side_source, SideSource::SourceName);
  EXPECT_TRUE(side_is_contradicted(both));
  EXPECT_THAT(doubts_of(both), ElementsAre(HasSubstr("by the shape of the bone it is a left knee")));
  ASSERT_TRUE(add_bones(tibia, femur));
  EXPECT_EQ(tibia.side, Side::Right);
  EXPECT_THAT(doubts_of(tibia), ElementsAre(HasSubstr("by the shape of the bone it is a left knee")));
  BoneImport other = femur;
  other.side = Side::Left;
  EXPECT_FALSE(add_bones(other, femur));
  EXPECT_EQ(other.bones.size(), 1U);
}

// What a fibula told was looked at before.
TEST(ShapeCheck, IsSilentOfTheSideWhereAFibulaTellsIt) {
  BoneImport import = knee(Side::Left, Side::Right);
  check_shapes(import, true);
  EXPECT_THAT(doubts_of(import), IsEmpty());
}

TEST(ShapeCheck, BothBonesTogetherTellTheSideButOneAloneDoesNot) {
  for (const Side side : {Side::Left, Side::Right}) {
    BoneImport import = knee(side, std::nullopt);
    check_shapes(import, false);
    EXPECT_EQ(import.side, side);
    EXPECT_EQ(import.side_source, SideSource::Shapes);
    EXPECT_THAT(doubts_of(import), AllOf(SizeIs(2), Each(HasSubstr("alone: check the side"))));
    BoneImport alone = knee(side, std::nullopt);
    alone.bones.pop_back();
    check_shapes(alone, false);
    EXPECT_FALSE(alone.side.has_value());
  }
}

// What is doubted as a bone already is not looked at.
TEST(ShapeCheck, LeavesWhatIsNoBoneAlone) {
  BoneImport import = knee(Side::Left, std::nullopt);
  for (auto& bone : import.bones) bone.doubts = {"no femur"};
  check_shapes(import, false);
  EXPECT_FALSE(import.side.has_value());
  for (const auto& bone : import.bones) EXPECT_THAT(bone.doubts, ElementsAre("no femur"));
}

}  // namespace
}  // namespace arthronaut::importing
