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
#include "tests/planning/segmentation/known_ct.h"
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

// Images alone make a case without bones, in which they are painted; the study is that of both.
TEST(CaseImport, ImagesAloneMakeACaseToPaintIn) {
  const TemporaryFolder folder;
  images::Volume volume;
  volume.size = {4, 3, 2};
  volume.modality_in_file = "MR";
  for (int v = 0; v < 24; ++v) volume.values.push_back(static_cast<float>(30 * v));
  images::write_volume(folder / "mr.nrrd", volume);
  BoneImportOptions options;
  options.side = Side::Left;
  options.images_only = true;
  BoneImport import = import_bones(folder / "mr.nrrd", options);
  EXPECT_TRUE(import.bones.empty());
  import.origin.study_uid = "1.2.3";
  add_to_case(folder / "a", import, "", folder / "mr.nrrd");
  const cases::Case made = cases::load_case(folder / "a");
  EXPECT_EQ(made.side, Side::Left);
  EXPECT_TRUE(made.bones.empty());
  ASSERT_EQ(made.images.size(), 1U);
  EXPECT_EQ(cases::load_image(folder / "a", made.images[0]).values, volume.values);
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    EXPECT_EQ(cases::load_studies(folder / "a").at(kind).study_uid, "1.2.3");
  // Nothing can be painted in a label map.
  volume.modality_in_file.clear();
  for (float& v : volume.values) v = v > 100 ? 1.0F : 0.0F;
  images::write_volume(folder / "labels.nrrd", volume);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "labels.nrrd", options); }),
              HasSubstr("is a label map"));
}

// Labels that were painted in a CT are not taken with another one's edges.
TEST(CaseImport, EdgesOfAnotherImageAreRefused) {
  const TemporaryFolder folder;
  images::Volume labels;
  labels.size = {8, 8, 8};
  labels.values.assign(512, 0.0F);
  for (int k = 2; k < 6; ++k)
    for (int j = 2; j < 6; ++j)
      for (int i = 2; i < 6; ++i) labels.values[labels.index(i, j, k)] = 1;
  images::write_volume(folder / "labels.nrrd", labels);
  images::Volume ct = labels;
  ct.modality_in_file = "CT";
  for (float& v : ct.values) v = v * 800 - 0.5F;
  ct.lps_from_index.translation().x() = 2;
  images::write_volume(folder / "ct.nrrd", ct);
  BoneImportOptions options;
  options.side = Side::Left;
  options.labels = {{BoneKind::Femur, 1}};
  options.edges_in = folder / "ct.nrrd";
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / "labels.nrrd", options); }),
              HasSubstr("is not the image that the labels were painted in"));
}

// A CT from a file that names no modality, as NIfTI never does and 3D Slicer's NRRD seldom, has edges as any
// other for the labels that were painted in it.
TEST(CaseImport, BonesPaintedInACtThatDoesNotSaySoLieAtItsEdges) {
  const TemporaryFolder folder;
  const geometry::TriangleMesh ball = test::ellipsoid({20, 18, 22}, 4);
  images::Volume ct = test::known_ct({ball}, {.spacing_mm = {1, 1, 1}, .margin_mm = 8});
  ct.modality_in_file.clear();
  ct.values.front() = -1000;
  images::write_volume(folder / "ct.nrrd", ct);
  images::Volume labels = ct;
  const auto covered = test::coverage(ball, ct, 3);
  for (std::size_t v = 0; v < covered.size(); ++v) labels.values[v] = covered[v] > 0.5F ? 1.F : 0.F;
  images::write_volume(folder / "labels.nrrd", labels);
  BoneImportOptions options;
  options.side = Side::Left;
  options.labels = {{BoneKind::Femur, 1}};
  const auto lines = [&] { return import_bones(folder / "labels.nrrd", options).bones.at(0).lines; };
  const auto lies_at_the_edge = testing::Contains(HasSubstr("at the edge that the CT shows"));
  EXPECT_THAT(lines(), Not(lies_at_the_edge));
  options.edges_in = folder / "ct.nrrd";
  EXPECT_THAT(lines(), lies_at_the_edge);
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

// A CT of 4 x 3 x 2 voxels of that value, as an import has it beside its bones.
void add_image(BoneImport& import, const TemporaryFolder& folder, float value) {
  images::Volume volume;
  volume.size = {4, 3, 2};
  volume.modality_in_file = "CT";
  volume.values.assign(24, value);
  volume.values.front() = 0.5F;  // no label map
  images::write_volume(folder / "ct.nrrd", volume);
  BoneImportOptions options;
  options.side = Side::Right;
  options.images_only = true;
  import.image = import_bones(folder / "ct.nrrd", options).image;
}

// A case of an older version says of its bones alone of which study they are; its image is of that study also
// after another one has come.
TEST(CaseImport, AnImageOfAnOlderVersionKeepsItsStudy) {
  const TemporaryFolder folder;
  BoneImport femur = imported(BoneKind::Femur);
  add_image(femur, folder, 100);
  femur.origin.study_uid = "1.2.3";
  femur.origin.frame_of_reference_uid = "1.2.3.1";
  add_to_case(folder / "a", femur, "", "bone.stl");
  cases::save_studies(folder / "a", cases::load_studies(folder / "a"));  // as it was then
  ASSERT_EQ(cases::study_of_image(folder / "a", "images/1.nrrd").study_uid, "1.2.3");
  BoneImport tibia = imported(BoneKind::Tibia);
  add_image(tibia, folder, 200);
  tibia.origin.study_uid = "4.5.6";
  tibia.origin.frame_of_reference_uid = "4.5.6.1";
  add_to_case(folder / "a", tibia, "", "bone.stl");
  EXPECT_EQ(cases::study_of_image(folder / "a", "images/1.nrrd").study_uid, "1.2.3");
  EXPECT_EQ(cases::study_of_image(folder / "a", "images/2.nrrd").study_uid, "4.5.6");
}

// Another knee's CT takes the place of a case's bones: it is said, and the image before is not shown with
// bones that are not of it.
TEST(CaseImport, AnotherKneeLeavesNoImageOfTheOneBefore) {
  const TemporaryFolder folder;
  BoneImport femur = imported(BoneKind::Femur);
  add_image(femur, folder, 100);
  EXPECT_THAT(replaced_in_words(folder / "a", femur), IsEmpty());
  add_to_case(folder / "a", femur, "", "bone.stl");
  EXPECT_THAT(replaced_in_words(folder / "a", femur), ElementsAre("replaced in the case: its femur"));
  add_to_case(folder / "a", femur, "", "bone.stl");  // the same once more
  ASSERT_EQ(cases::load_case(folder / "a").images.size(), 1U);

  BoneImport both = imported(BoneKind::Femur);
  both.bones.push_back(imported(BoneKind::Tibia).bones[0]);
  add_image(both, folder, 200);
  EXPECT_THAT(
      replaced_in_words(folder / "a", both),
      ElementsAre("replaced in the case: its femur",
                  "images/1.nrrd, of the bones before, is no image of the case any more; its file stays"));
  add_to_case(folder / "a", both, "", "bone.stl");
  const cases::Case after = cases::load_case(folder / "a");
  ASSERT_EQ(after.images.size(), 1U);
  EXPECT_EQ(cases::load_image(folder / "a", after.images[0]).values.back(), 200);
  EXPECT_TRUE(std::filesystem::exists(folder / "a/images/1.nrrd"));

  // The tibia that stays is of the image that is there.
  BoneImport one = imported(BoneKind::Femur);
  add_image(one, folder, 300);
  add_to_case(folder / "a", one, "", "bone.stl");
  EXPECT_EQ(cases::load_case(folder / "a").images.size(), 2U);
}

// Bones of another series of the same place: its images still show where they lie.
TEST(CaseImport, AnImageOfTheSameFrameOfReferenceStays) {
  const TemporaryFolder folder;
  BoneImport femur = imported(BoneKind::Femur);
  femur.origin.study_uid = "1.2";
  femur.origin.frame_of_reference_uid = "1.2.7";
  add_image(femur, folder, 100);
  add_to_case(folder / "a", femur, "", "bone.stl");
  add_image(femur, folder, 200);
  add_to_case(folder / "a", femur, "", "bone.stl");
  EXPECT_EQ(cases::load_case(folder / "a").images.size(), 2U);
}

// One bone of another scan lies where the patient lay then: it is said, and the case knows it when it is
// loaded.
TEST(CaseImport, Hazard51BonesOfTwoFramesOfReferenceAreSaid) {
  const TemporaryFolder folder;
  BoneImport tibia = imported(BoneKind::Tibia), femur = imported(BoneKind::Femur);
  tibia.origin.study_uid = femur.origin.study_uid = "1.2";
  tibia.origin.frame_of_reference_uid = femur.origin.frame_of_reference_uid = "1.2.7";
  add_to_case(folder / "a", tibia, "", "ct");
  EXPECT_THAT(replaced_in_words(folder / "a", femur), IsEmpty());
  EXPECT_FALSE(add_to_case(folder / "a", femur, "", "ct").is_of_two_frames);
  EXPECT_FALSE(cases::load_case(folder / "a").is_of_two_frames);

  femur.origin.frame_of_reference_uid = "1.2.8";
  EXPECT_THAT(replaced_in_words(folder / "a", femur),
              ElementsAre("replaced in the case: its femur", HasSubstr("different frames of reference")));
  EXPECT_TRUE(add_to_case(folder / "a", femur, "", "ct").is_of_two_frames);
  EXPECT_TRUE(cases::load_case(folder / "a").is_of_two_frames);

  add_to_case(folder / "a", imported(BoneKind::Femur), "", "bone.stl");  // nobody knows of which
  EXPECT_FALSE(cases::load_case(folder / "a").is_of_two_frames);
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
