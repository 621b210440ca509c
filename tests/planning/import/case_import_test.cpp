#include "planning/import/case_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/cases/study.h"
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
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

BoneImport imported(BoneKind kind, std::optional<Side> side = Side::Right) {
  BoneImport import;
  import.side = side;
  ImportedBone bone;
  bone.bone = {kind, test::ellipsoid({40, 30, 25}, 2), "bone.stl"};
  import.bones.push_back(bone);
  return import;
}

TEST(CaseImport, MakesACaseAndAddsToIt) {
  const TemporaryFolder folder;
  const cases::Case made =
      add_to_case(folder / "Mustermann.arthro", imported(BoneKind::Femur), "", "bone.stl");
  // A folder may carry the patient's name: the case does not take it over.
  EXPECT_THAT(made.name, AllOf(Not(IsEmpty()), Not(HasSubstr("Mustermann"))));
  EXPECT_THAT(folder.names(), ElementsAre("Mustermann.arthro"));
  add_to_case(folder / "Mustermann.arthro", imported(BoneKind::Tibia), "Other", "bone.stl");
  const cases::Case both = cases::load_case(folder / "Mustermann.arthro");
  EXPECT_EQ(both.bones.size(), 2U);
  EXPECT_EQ(both.name, "Other");
  EXPECT_EQ(both.side, Side::Right);
}

// An empty folder, as made for it, becomes the case; folders that are not there are made.
TEST(CaseImport, TakesAnEmptyFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "empty");
  add_to_case(folder / "empty/", imported(BoneKind::Femur), "", "bone.stl");
  EXPECT_EQ(cases::load_case(folder / "empty").bones.size(), 1U);
  add_to_case(folder / "new/Mustermann.arthro", imported(BoneKind::Femur), "", "bone.stl");
  EXPECT_EQ(cases::load_case(folder / "new/Mustermann.arthro").bones.size(), 1U);
}

TEST(CaseImport, WhatItRefusesStaysAsItWas) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "letter.txt", "Dear colleague");
  EXPECT_THAT(
      message_of<InvalidInput>([&] { add_to_case(folder.path(), imported(BoneKind::Femur), "", ""); }),
      HasSubstr("not a case"));
  EXPECT_THAT(message_of<InvalidInput>([&] {
                add_to_case(folder / "a", imported(BoneKind::Femur, std::nullopt), "", "bone.stl");
              }),
              HasSubstr("bone.stl: "));
  // A parent that is a file: nothing can be made below it.
  EXPECT_THAT(message_of<IoError>(
                  [&] { add_to_case(folder / "letter.txt/a", imported(BoneKind::Femur), "", "bone.stl"); }),
              HasSubstr("letter.txt/a"));
  EXPECT_THAT(folder.names(), ElementsAre("letter.txt"));
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  EXPECT_THAT(message_of<InvalidInput>(
                  [&] { add_to_case(folder / "a", imported(BoneKind::Tibia, Side::Left), "", "bone.stl"); }),
              HasSubstr("right knee"));
  EXPECT_EQ(cases::load_case(folder / "a").bones.size(), 1U);
}

// Of each bone the case knows its study; a mesh that takes a bone's place is of none.
TEST(CaseImport, KeepsOfWhichStudyABoneIs) {
  const TemporaryFolder folder;
  BoneImport of_images = imported(BoneKind::Femur);
  of_images.origin.study_uid = "1.2.3";
  add_to_case(folder / "a", of_images, "", "ct");
  EXPECT_EQ(cases::load_studies(folder / "a").at(BoneKind::Femur), of_images.origin);
  of_images.bones[0].bone.kind = BoneKind::Tibia;
  of_images.origin.study_uid = "1.2.4";
  add_to_case(folder / "a", of_images, "", "ct");
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  const cases::Studies studies = cases::load_studies(folder / "a");
  ASSERT_EQ(studies.size(), 1U);
  EXPECT_EQ(studies.at(BoneKind::Tibia), of_images.origin);
}

// A bone that is planned on is not exchanged under its tunnel.
TEST(CaseImport, ABoneThatIsPlannedOnStays) {
  const TemporaryFolder folder;
  cases::Case planned = add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  planned.plan.tunnels[BoneKind::Femur] = {};
  cases::save_case(folder / "a", planned);
  EXPECT_THAT(message_of<InvalidInput>([&] { add_to_case(folder / "a", imported(BoneKind::Femur), "", ""); }),
              HasSubstr("plan on its femur"));
}

}  // namespace
}  // namespace arthronaut::importing
