// The images that a case keeps beside its bones: painted in, followed at their edges, replaced.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/study.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_writer.h"
#include "planning/import/case_import.h"
#include "tests/message_of.h"
#include "tests/planning/import/imported_bone.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using test::imported;
using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

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

}  // namespace
}  // namespace arthronaut::importing
