#include "planning/import/case_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/study.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_writer.h"
#include "planning/import/import_side.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/import/imported_bone.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using test::imported;
using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(CaseImport, MakesACaseAndAddsToIt) {
  const TemporaryFolder folder;
  const cases::Case made =
      add_to_case(folder / "Mustermann.arthro", imported(BoneKind::Femur), "", "bone.stl");
  // A folder may carry the patient's name: the case does not take it over.
  EXPECT_THAT(made.name, AllOf(Not(IsEmpty()), Not(HasSubstr("Mustermann"))));
  // By its time: a second one of the same day has another name.
  EXPECT_THAT(made.name, testing::MatchesRegex("Knee ....-..-.. ..:..:.."));
  EXPECT_THAT(folder.names(), ElementsAre("Mustermann.arthro"));
  add_to_case(folder / "Mustermann.arthro", imported(BoneKind::Tibia), "Other", "bone.stl");
  const cases::Case both = cases::load_case(folder / "Mustermann.arthro");
  EXPECT_EQ(both.bones.size(), 2U);
  EXPECT_EQ(both.name, "Other");
  EXPECT_EQ(both.side, Side::Right);
}

// A bone that says no side of its own, but is shaped as of the other knee than the case's.
TEST(CaseImport, ABoneThatIsShapedAsOfTheOtherKneeIsDoubted) {
  const TemporaryFolder folder;
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  BoneImport tibia = imported(BoneKind::Tibia, std::nullopt);
  tibia.bones[0].shape_was_judged = true;
  tibia.bones[0].side_by_shape = Side::Left;
  add_to_case(folder / "a", tibia, "", "bone.stl");
  EXPECT_THAT(words_of(cases::load_bone_doubts(folder / "a").at(BoneKind::Tibia)),
              ElementsAre(HasSubstr("by the shape of the bone it is a left knee, but the side is right")));
}

// Images that say less of the patient than those before take nothing of it away.
TEST(CaseImport, ASecondSourceTakesNothingOfTheIdentityAway) {
  const TemporaryFolder folder;
  BoneImport femur = imported(BoneKind::Femur), tibia = imported(BoneKind::Tibia);
  femur.identity = {"Muster^Anna", "4711", "19700102"};
  tibia.identity = {"", "4711", ""};
  add_to_case(folder / "a", femur, "", "bone.stl");
  add_to_case(folder / "a", tibia, "", "bone.stl");
  EXPECT_EQ(cases::load_identity(folder / "a"), femur.identity);
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

// Of a CT whose crop leaves the fibula out nothing is wrong with its name: what was asked is said, and why it
// does not tell, and what does.
TEST(CaseImport, ASideThatNothingTellsIsAskedForWithTheReasons) {
  const TemporaryFolder folder;
  BoneImport import = imported(BoneKind::Femur, std::nullopt);
  import.bones.push_back(imported(BoneKind::Tibia, std::nullopt).bones.front());
  for (ImportedBone& bone : import.bones) bone.shape_was_judged = true;
  import.bones[0].side_by_shape = Side::Left;
  EXPECT_TRUE(shapes_may_tell(import));
  import.why_no_side = why_no_side(import, "no fibula is seen");
  EXPECT_EQ(
      message_of<InvalidInput>([&] { add_to_case(folder / "a", import, "", "scan"); }),
      "scan: nothing tells which knee it is: its name does not say it, nor does a mark in images; no "
      "fibula is seen; the shapes of femur and tibia do not tell it both alike. Look at the images or at "
      "the request for them, and add --side left or --side right");
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  for (ImportedBone& bone : import.bones) bone.shape_was_judged = false;
  import.bones[0].doubts = {"it is no femur"};
  EXPECT_FALSE(shapes_may_tell(import));
  EXPECT_THAT(why_no_side(import, ""), HasSubstr("images; the shapes of the bones are in doubt themselves."));
  import.bones.pop_back();
  import.side_in_images = Side::Left;
  EXPECT_THAT(why_no_side(import, ""),
              HasSubstr("is: its name and the mark in its images say different "
                        "sides; the shape of one bone alone does not tell it surely."));
}

// Half a minute of making bones is not spent on a folder that cannot take them.
TEST(CaseImport, RefusesAFolderBeforeTheWork) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(refuse_folder(folder / "New.arthro"));
  EXPECT_NO_THROW(refuse_folder(folder / "not" / "there" / "New.arthro"));
  EXPECT_TRUE(folder.names().empty()) << "looking leaves nothing behind";
  test::write_bytes(folder / "file", "text");
  EXPECT_THAT(message_of<InvalidInput>([&] { refuse_folder(folder / "file"); }), HasSubstr("is not a case"));
  EXPECT_THAT(message_of<IoError>([&] { refuse_folder(folder / "file" / "New.arthro"); }),
              HasSubstr("Not a directory"));
  cases::save_case(folder / "Old.arthro", {});
  EXPECT_NO_THROW(refuse_folder(folder / "Old.arthro"));
}

// Asked for one after the other, a person would start twice more.
TEST(CaseImport, BoneAndSideAreAskedForAtOnce) {
  const TemporaryFolder folder;
  for (const char* name : {"bone.stl", "femur.stl", "right.stl"}) test::write_bytes(folder / name, "solid");
  const auto asked = [&](const char* name) {
    return message_of<InvalidInput>([&] { refuse_missing_side(folder / "a", folder / name, {}); });
  };
  EXPECT_THAT(asked("bone.stl"),
              AllOf(HasSubstr("bone.stl: "), HasSubstr("--bone femur"), HasSubstr("--side left")));
  EXPECT_THAT(asked("femur.stl"), AllOf(HasSubstr("--side left"), Not(HasSubstr("--bone"))));
  EXPECT_NO_THROW(refuse_missing_side(folder / "a", folder / "right.stl", {})) << "the bone alone: later";
  cases::save_case(folder / "Old.arthro", {});
  EXPECT_NO_THROW(refuse_missing_side(folder / "Old.arthro", folder / "bone.stl", {})) << "the case has one";
}

// The import takes the side from the segment's name: nobody is asked for it before.
TEST(CaseImport, ASideThatASegmentsNameSaysIsNotAskedFor) {
  const TemporaryFolder folder;
  BoneImportOptions one_label;
  one_label.labels = {{BoneKind::Femur, 9}};
  const std::filesystem::path file = folder / "knee.seg.nrrd";
  const auto ask = [&](const char* name) {
    test::write_bytes(file, std::string("NRRD0004\nSegment0_LabelValue:=9\nSegment0_Name:=") + name +
                                "\nSegment0_Tags:=left\n\nSegment1_Name:=left");
    refuse_missing_side(folder / "a", file, one_label);
  };
  EXPECT_NO_THROW(ask("Right femur"));
  EXPECT_NO_THROW(ask("right/femur"));
  EXPECT_THAT(message_of<InvalidInput>([&] { ask("Femur"); }), HasSubstr("--side left"));
}

// Nobody is asked which bone it is that a file without a byte holds.
TEST(CaseImport, AnEmptyMeshIsRefusedForBeingEmpty) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "bone.stl", "");
  EXPECT_THAT(message_of<InvalidInput>([&] { refuse_missing_side(folder / "a", folder / "bone.stl", {}); }),
              HasSubstr("bone.stl: is empty"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "bone.stl"); }),
              HasSubstr("bone.stl: is empty"));
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

// Hazard 46: what spoke against a bone is in the case as long as the bone is; another one brings its own.
TEST(CaseImport, Hazard46WhatSpokeAgainstABoneStaysWithTheCase) {
  const TemporaryFolder folder;
  BoneImport cut = imported(BoneKind::Femur);
  cut.bones[0].doubts = {"the images end within it"};
  const bones::ImageCut narrow{.area_mm2 = 50};  // no doubt, and kept for what is planned there
  cut.bones[0].image_cuts = {narrow};
  cases::BoneDoubts all{{BoneKind::Femur, {cut.bones[0].doubts[0], narrow, cases::SurfaceLookedAt{}}}};
  add_to_case(folder / "a", cut, "", "ct");
  EXPECT_EQ(cases::load_bone_doubts(folder / "a"), all);
  add_to_case(folder / "a", imported(BoneKind::Tibia), "", "bone.stl");
  all[BoneKind::Tibia] = {cases::SurfaceLookedAt{}};
  EXPECT_EQ(cases::load_bone_doubts(folder / "a"), all) << "a tibia changes nothing of it";
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  all[BoneKind::Femur] = {cases::SurfaceLookedAt{}};
  EXPECT_EQ(cases::load_bone_doubts(folder / "a"), all);
}

// That the side rests on a person's word alone stays with the case, whatever comes in place of its bones,
// until something bears it out.
TEST(CaseImport, Hazard52ASideThatWasOnlySaidIsNotedUntilSomethingBearsItOut) {
  const TemporaryFolder folder;
  const auto note = [&] { return plan_review::side_note(cases::load_bone_doubts(folder / "a")); };
  BoneImport said = imported(BoneKind::Femur);
  said.side_source = SideSource::Person;
  add_to_case(folder / "a", said, "", "bone.stl");
  EXPECT_THAT(note(), HasSubstr("a right knee, as said"));
  EXPECT_TRUE(plan_review::verdict_of_bones(cases::load_bone_doubts(folder / "a")).is_fine());
  add_to_case(folder / "a", imported(BoneKind::Femur, std::nullopt), "", "bone.stl");
  EXPECT_THAT(note(), HasSubstr("a right knee, as said")) << "another femur that tells no side";
  BoneImport tibia = imported(BoneKind::Tibia, std::nullopt);
  tibia.side_by_fibula = Side::Right;
  add_to_case(folder / "a", tibia, "", "ct");
  EXPECT_EQ(note(), "");
  add_to_case(folder / "a", said, "", "bone.stl");
  EXPECT_EQ(note(), "") << "what was borne out before is not less so";
}

// Of images whose bones will be painted.
TEST(CaseImport, ASideThatWasOnlySaidOfImagesIsNotedOfTheBonesPaintedInThem) {
  const TemporaryFolder folder;
  BoneImport images;
  images.side = Side::Left;
  images.side_source = SideSource::Person;
  add_to_case(folder / "a", images, "", "mr");
  add_to_case(folder / "a", imported(BoneKind::Tibia, std::nullopt), "", "bones.nrrd");
  const cases::BoneDoubts doubts = cases::load_bone_doubts(folder / "a");
  EXPECT_THAT(words_of(doubts.at(BoneKind::Tibia)), ElementsAre(HasSubstr("a left knee, as said")));
}

// An import that fails half-way, here at a tibia that cannot be written, leaves no landmark, no cartilage and
// no study of the femur that it has replaced, and no image.
TEST(CaseImport, WhatFailsHalfWayLeavesNothingOnAnotherSurface) {
  const TemporaryFolder folder;
  cases::Case made = add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  made.landmarks[BoneKind::Femur]["medial_epicondyle"] = {40, 0, 0};
  cases::save_case(folder / "a", made);
  cases::save_cartilage(folder / "a", BoneKind::Femur, test::box({4, 4, 1}));
  images::DicomOrigin study;
  study.study_uid = "1.2.3";
  cases::save_studies(folder / "a", {{BoneKind::Femur, study}});
  std::filesystem::create_directory(cases::mesh_file(folder / "a", BoneKind::Tibia));
  BoneImport both = imported(BoneKind::Femur);
  both.bones[0].bone.mesh = test::ellipsoid({38, 30, 25}, 2);
  both.bones.push_back(imported(BoneKind::Tibia).bones[0]);
  images::Volume volume;
  volume.size = {4, 3, 2};
  volume.values.assign(24, 0.0F);
  images::write_volume(folder / "ct.nrrd", volume);
  BoneImportOptions options;
  options.side = Side::Right;
  options.images_only = true;
  both.image = import_bones(folder / "ct.nrrd", options).image;
  ASSERT_TRUE(both.image);
  EXPECT_THAT(message_of<IoError>([&] { add_to_case(folder / "a", both, "", "bone.stl"); }),
              HasSubstr("tibia.ply"));
  const cases::Case after = cases::load_case(folder / "a");
  EXPECT_EQ(after.bones.at(BoneKind::Femur).mesh.vertices_mm, both.bones[0].bone.mesh.vertices_mm);
  EXPECT_TRUE(after.landmarks.empty());
  EXPECT_FALSE(cases::load_cartilage(folder / "a", BoneKind::Femur));
  EXPECT_TRUE(cases::load_studies(folder / "a").empty()) << "it is not of that study";
  EXPECT_TRUE(after.images.empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "a/images/1.nrrd"));
}

// What a newer program keeps in the case cannot be read: nothing of the bone before is forgotten for it.
TEST(CaseImport, WhatCannotBeReadIsFoundOutBeforeAnythingIsForgotten) {
  const TemporaryFolder folder;
  cases::Case made = add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  made.landmarks[BoneKind::Femur]["medial_epicondyle"] = {40, 0, 0};
  cases::save_case(folder / "a", made);
  std::ofstream(folder / "a/bone_doubts.json") << R"({"format": "arthronaut.bone_doubts", "version": 99})";
  BoneImport other = imported(BoneKind::Femur);
  other.bones[0].bone.mesh = test::ellipsoid({38, 30, 25}, 2);
  EXPECT_THAT(message_of<InvalidInput>([&] { add_to_case(folder / "a", other, "", "bone.stl"); }),
              HasSubstr("bone_doubts.json"));
  const cases::Case after = cases::load_case(folder / "a");
  EXPECT_EQ(after.bones.at(BoneKind::Femur).mesh.vertices_mm,
            made.bones.at(BoneKind::Femur).mesh.vertices_mm);
  EXPECT_EQ(after.landmarks.size(), 1U);
}

// Cartilage is of the surface that it was declared on; that of the bone that stays, stays.
TEST(CaseImport, AReplacedBoneLosesItsCartilage) {
  const TemporaryFolder folder;
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  add_to_case(folder / "a", imported(BoneKind::Tibia), "", "bone.stl");
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    cases::save_cartilage(folder / "a", kind, test::box({4, 4, 1}));
  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");
  EXPECT_FALSE(cases::load_cartilage(folder / "a", BoneKind::Femur));
  EXPECT_TRUE(cases::load_cartilage(folder / "a", BoneKind::Tibia));
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
