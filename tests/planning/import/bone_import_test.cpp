#include "planning/import/bone_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using test::message_of;
using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;

TEST(BoneImport, NamesTellBoneAndSide) {
  EXPECT_EQ(bone_kind_in_name("/left/3_RIGHT_femur_Nov.vtk"), BoneKind::Femur);
  EXPECT_EQ(side_in_name("/left/3_RIGHT_femur_Nov.vtk"), Side::Right);
  EXPECT_EQ(side_in_name("lenhart-R-tibia-bone.stl"), Side::Right);
  EXPECT_EQ(bone_kind_in_name("Tibia_L.stl"), BoneKind::Tibia);
  EXPECT_EQ(side_in_name("Tibia_L.stl"), Side::Left);
  EXPECT_EQ(side_in_name("LEFT/"), Side::Left);
  EXPECT_EQ(side_in_name("bright_femur.stl"), std::nullopt);    // not a word
  EXPECT_EQ(side_in_name("left_not_right.stl"), std::nullopt);  // both
  EXPECT_EQ(bone_kind_in_name("femur_and_tibia.nrrd"), std::nullopt);
  EXPECT_EQ(bone_kind_in_name("patella.stl"), std::nullopt);
}

TEST(BoneImport, LabelsAreParsedStrictly) {
  const auto labels = labels_from_text("femur=5,tibia=6");
  EXPECT_EQ(labels.at(BoneKind::Femur), 5);
  EXPECT_EQ(labels.at(BoneKind::Tibia), 6);
  for (const char* bad :
       {"", "femur", "femur=", "=5", "femur=5,", "femur=5x", "patella=7", "femur=5,femur=6", "5"}) {
    EXPECT_THROW((void)labels_from_text(bad), InvalidInput) << bad;
  }
}

TEST(BoneImport, AMeshBecomesAClosedOutwardBone) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = test::ellipsoid({40, 30, 25}, 3, {-30, 0, 0});
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  mesh.triangles.pop_back();
  test::write_bytes(folder / "right_femur.stl", test::binary_stl(mesh));
  const BoneImport import = import_bones(folder / "right_femur.stl");
  ASSERT_EQ(import.bones.size(), 1U);
  EXPECT_EQ(import.side, Side::Right);
  EXPECT_TRUE(import.side_was_guessed);
  EXPECT_TRUE(import.bones[0].repair.is_closed);
  EXPECT_GT(geometry::signed_volume_mm3(import.bones[0].bone.mesh), 0);
  EXPECT_EQ(import.bones[0].bone.source, "binary STL");
  EXPECT_TRUE(import.identity.is_empty());
  EXPECT_THAT(import.bones[0].lines, Contains(HasSubstr("inside out")));
  EXPECT_THAT(import.bones[0].lines, Contains(HasSubstr("1 hole")));
  EXPECT_TRUE(import.bones[0].doubts.empty());
}

// The classic: a RAS file read as LPS puts a right knee on the left.
TEST(BoneImport, ABoneOnTheOtherSideRaisesADoubt) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "femur.stl", test::binary_stl(test::ellipsoid({40, 30, 25}, 3, {90, 0, 0})));
  BoneImportOptions options;
  options.side = Side::Right;
  EXPECT_THAT(import_bones(folder / "femur.stl", options).bones.at(0).doubts, Contains(HasSubstr("--space")));
  options.space = bones::Space::RAS;
  EXPECT_TRUE(import_bones(folder / "femur.stl", options).bones.at(0).doubts.empty());
}

TEST(BoneImport, WhatIsNotSaidIsAskedFor) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "bone.stl", test::binary_stl(test::ellipsoid({40, 30, 25}, 2)));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "bone.stl"); }),
              HasSubstr("--bone femur"));
  EXPECT_THROW((void)import_bones(folder / "absent.stl"), IoError);
  test::write_bytes(folder / "notes.txt", "x");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "notes.txt"); }),
              HasSubstr("DICOM"));
  BoneImportOptions options;
  options.threshold = 300;
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "bone.stl", options); }),
              HasSubstr("volumes"));
}

}  // namespace
}  // namespace arthronaut::importing
