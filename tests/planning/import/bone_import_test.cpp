#include "planning/import/bone_import.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/geometry/error.h"
#include "planning/images/volume_writer.h"
#include "planning/import/case_import.h"
#include "planning/import/import_side.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/planning/segmentation/known_mr.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using test::message_of;
using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

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

phantom::PhantomOptions coarse() {
  phantom::PhantomOptions options;
  options.edge_length_mm = 2;
  return options;
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
  EXPECT_TRUE(is_guess(import.side_source));
  EXPECT_TRUE(import.bones[0].repair.is_closed);
  EXPECT_GT(geometry::signed_volume_mm3(import.bones[0].bone.mesh), 0);
  EXPECT_EQ(import.bones[0].bone.source, "binary STL");
  EXPECT_TRUE(import.identity.is_empty());
  EXPECT_THAT(import.bones[0].lines, Contains(HasSubstr("inside out")));
  EXPECT_THAT(import.bones[0].lines, Contains(HasSubstr("1 hole")));
  // Closed and outward, but no femur.
  ASSERT_EQ(import.bones[0].doubts.size(), 1U);
  EXPECT_THAT(import.bones[0].doubts[0], HasSubstr("does not look like a femur"));
}

// Where the table stood says nothing about the side: a left knee may lie on the scanner's right.
TEST(BoneImport, ABoneOfTheBuiltInKneeRaisesNoDoubtWhereverItLies) {
  const TemporaryFolder folder;
  for (const double x : {-90.0, 90.0}) {
    geometry::TriangleMesh mesh = phantom::make_phantom_knee(coarse()).femur.mesh;
    for (auto& p : mesh.vertices_mm) p.x() += x;
    test::write_bytes(folder / "femur.stl", test::binary_stl(mesh));
    BoneImportOptions options;
    options.side = Side::Right;
    EXPECT_THAT(import_bones(folder / "femur.stl", options).bones.at(0).doubts, testing::IsEmpty());
  }
}

// A file whose second axis is up, read as if it were LPS.
TEST(BoneImport, AxesThatAreNotThePatientsRaiseADoubt) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = phantom::make_phantom_knee(coarse()).femur.mesh;
  for (auto& p : mesh.vertices_mm) p = Eigen::Vector3d(p.x(), p.z(), -p.y());
  test::write_bytes(folder / "femur.stl", test::binary_stl(mesh));
  EXPECT_THAT(import_bones(folder / "femur.stl").bones.at(0).doubts, Contains(HasSubstr("axes of the file")));
}

// Label 9 above label 2, of no bone's shape.
images::Volume two_blocks() {
  images::Volume volume;
  volume.size = {40, 40, 40};
  volume.lps_from_index.linear() = Eigen::Vector3d(1, 1, 1).asDiagonal();
  volume.values.assign(64000, 0.0F);
  for (int k = 5; k < 35; ++k) {
    for (int j = 5; j < 35; ++j) {
      for (int i = 5; i < 35; ++i)
        volume.values[volume.index(i, j, k)] = k < 15 ? 2.0F : k > 20 ? 9.0F : 0.0F;
    }
  }
  return volume;
}

// A label map of 3D Slicer says by names which label is which bone.
TEST(BoneImport, SegmentsAreFoundByTheirNames) {
  const TemporaryFolder folder;
  images::Volume volume = two_blocks();
  volume.segments = {{"Femoral cartilage femur", 1}, {"Right Femur", 9}, {"tibia", 2}};
  images::write_volume(folder / "knee.seg.nrrd", volume);
  const BoneImport import = import_bones(folder / "knee.seg.nrrd");
  ASSERT_EQ(import.bones.size(), 2U);
  EXPECT_EQ(import.bones[0].bone.kind, BoneKind::Femur);
  EXPECT_EQ(import.bones[0].bone.source, "label 9 of NRRD");
  EXPECT_EQ(import.bones[1].bone.source, "label 2 of NRRD");
  ASSERT_TRUE(import.image.has_value());
  EXPECT_TRUE(import.image->image.is_label_map);
}

// The side that a segment's name tells is one by a name: it is said, a person's word goes before it, and two
// names that contradict each other tell none.
TEST(BoneImport, ASegmentsNameTellsTheSide) {
  const TemporaryFolder folder;
  images::Volume volume = two_blocks();
  const auto import_as = [&](const char* file, const char* femur, const char* tibia,
                             const BoneImportOptions& options = {}) {
    volume.segments = {{femur, 9}, {tibia, 2}};
    images::write_volume(folder / file, volume);
    return import_bones(folder / file, options);
  };
  const BoneImport right = import_as("knee.seg.nrrd", "Right femur", "tibia");
  EXPECT_EQ(right.side, Side::Right);
  EXPECT_EQ(right.side_source, SideSource::SegmentName);
  EXPECT_THAT(right.lines, Contains("segment \"Right femur\" says that it is a right knee"));

  const BoneImport both = import_as("knee.seg.nrrd", "Right femur", "Left tibia");
  EXPECT_EQ(both.side, std::nullopt);
  EXPECT_EQ(both.side_source, SideSource::None);
  EXPECT_THAT(both.lines, Contains(HasSubstr("do not say the same side")));
  const BoneImport by_file = import_as("left.seg.nrrd", "Right femur", "tibia");
  EXPECT_EQ(by_file.side, std::nullopt);

  BoneImportOptions said;
  said.side = Side::Left;
  EXPECT_EQ(import_as("knee.seg.nrrd", "Right femur", "Right tibia", said).side, Side::Left);
  BoneImportOptions femur_alone;
  femur_alone.kind = BoneKind::Femur;
  EXPECT_EQ(import_as("knee.seg.nrrd", "Right femur", "Left tibia", femur_alone).side, Side::Right);
}

// How the scanner's images are marked is no more than a name: a person's word goes before it, but not unsaid.
TEST(BoneImport, TheMarkOfTheImagesTellsTheSide) {
  const TemporaryFolder folder;
  test::DicomSeriesForm form;
  form.change = [](DcmDataset& dataset, int) {
    ASSERT_TRUE(dataset.putAndInsertString(DCM_Laterality, "L").good());
  };
  for (const char* name : {"scan", "right"})
    test::write_dicom_series(folder / name, test::ellipsoid_ct(), form);
  BoneImportOptions options;
  options.images_only = true;
  const BoneImport marked = import_bones(folder / "scan", options);
  EXPECT_EQ(marked.side, Side::Left);
  EXPECT_EQ(marked.side_source, SideSource::ImageMark);
  EXPECT_THAT(marked.lines, Contains("the images are marked as those of a left knee"));

  const BoneImport named = import_bones(folder / "right", options);
  EXPECT_EQ(named.side, std::nullopt);
  EXPECT_THAT(named.lines, Contains(HasSubstr("neither is taken")));

  options = {};
  options.kind = BoneKind::Femur;
  options.side = Side::Right;
  BoneImport said = import_bones(folder / "scan", options);
  EXPECT_EQ(said.side, Side::Right);
  EXPECT_TRUE(side_is_contradicted(said));
  const cases::BoneDoubt doubt = cases::SideDoubt{cases::SideWitness::ImageMark, Side::Left, Side::Right};
  EXPECT_THAT(doubts_with(said, said.bones.front(), Side::Right), Contains(doubt));
  say_side(said, Side::Left);
  EXPECT_FALSE(side_is_contradicted(said));
  EXPECT_THAT(doubts_with(said, said.bones.front(), Side::Left), Not(Contains(doubt)));
}

TEST(BoneImport, TheShapeOfAKneeIsHeldAgainstTheSideThatASegmentsNameTells) {
  const TemporaryFolder folder;
  images::Volume right_knee = test::known_labels();
  right_knee.segments = {{"femur", 5}, {"tibia_L", 6}};
  images::write_volume(folder / "knee.seg.nrrd", right_knee);
  const BoneImport import = import_bones(folder / "knee.seg.nrrd");
  EXPECT_EQ(import.side, Side::Left);
  EXPECT_TRUE(is_guess(import.side_source));
  EXPECT_TRUE(side_is_contradicted(import));
}

std::vector<std::string> doubts_of_first(const BoneImport& import) {
  return cases::words_of(doubts_with(import, import.bones.front(), import.side));
}

// A knee that fills the images up to their front edge: the bone ends there, flat, and what was in front of it
// is missing. Through the shaft every scan cuts.
TEST(BoneImport, Hazard46ABoneThatTheEdgeOfTheImagesCutsRaisesADoubt) {
  const TemporaryFolder folder;
  images::Volume volume;
  volume.size = {60, 60, 60};
  volume.values.assign(60 * 60 * 60, 0.0F);
  for (int k = 30; k < 60; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 10; i < 50; ++i) volume.values[volume.index(i, j, k)] = 1.0F;
  BoneImportOptions options;
  options.labels = {{BoneKind::Femur, 1}};
  const auto import_of = [&](const char* name) {
    images::write_volume(folder / name, volume);
    return import_bones(folder / name, options);
  };
  const auto doubts_at = [&](const char* name) { return doubts_of_first(import_of(name)); };
  // 40 by 30 mm, less a rim of a voxel that is rounded off.
  const auto is_cut = [](const char* area) {
    return Contains(HasSubstr(std::string(area) + " cm\u00B2 of it are cut off flat in front"));
  };
  EXPECT_THAT(doubts_at("cut.nrrd"), testing::AnyOf(is_cut("10"), is_cut("11"), is_cut("12")));
  EXPECT_THAT(doubts_at("cut.nrrd"), Not(Contains(HasSubstr("cut off flat above"))));
  // The face lies half a voxel before the first row, and a place on it is told from one beside it.
  const auto cuts = import_of("cut.nrrd").bones.at(0).image_cuts;
  ASSERT_EQ(cuts.size(), 1U);
  EXPECT_TRUE(cuts[0].out.isApprox(Eigen::Vector3d(0, -1, 0)));
  EXPECT_LT((cuts[0].at_mm - Eigen::Vector3d(29.5, 0.25, 44.5)).norm(), 1) << "in its middle";
  EXPECT_TRUE(cuts[0].is_reached({20, -0.5, 50}));
  EXPECT_FALSE(cuts[0].is_reached({20, 1, 50}));
  EXPECT_FALSE(cuts[0].is_reached({20, 29.5, 50}));
  volume.lps_from_index.translation().y() = 5;
  for (int k = 30; k < 60; ++k)
    for (int i = 10; i < 50; ++i) volume.values[volume.index(i, 0, k)] = 0.0F;
  EXPECT_THAT(doubts_at("whole.nrrd"), Not(Contains(HasSubstr("cut off flat"))));
}

// A person alone is believed, and what he said is told from what the images show. Once anything of them says
// the same or another side, that stands in its place.
TEST(BoneImport, ASideThatNothingBearsOutIsNotedAsSaid) {
  BoneImport import;
  import.bones.resize(1);
  EXPECT_FALSE(side_note(import, bones::Side::Right)) << "nobody said anything";
  EXPECT_TRUE(side_note(import, bones::Side::Right, true)) << "it is being said";
  say_side(import, bones::Side::Right);
  ASSERT_TRUE(side_note(import, bones::Side::Right));
  EXPECT_EQ(side_note(import, bones::Side::Right)->words(),
            "a right knee, as said: nothing in the images or the shape of the bones confirms it");
  EXPECT_TRUE(doubts_of_first(import).empty()) << "it speaks against nothing";
  for (const bones::Side told : {bones::Side::Right, bones::Side::Left}) {
    BoneImport marked = import, with_fibula = import, with_shape = import;
    marked.side_in_images = with_fibula.side_by_fibula = told;
    with_shape.bones[0].shape_was_judged = true;
    with_shape.bones[0].side_by_shape = told;
    for (const BoneImport& witnessed : {marked, with_fibula, with_shape}) {
      EXPECT_FALSE(side_note(witnessed, bones::Side::Right));
      EXPECT_EQ(doubts_of_first(witnessed).empty(), told == bones::Side::Right);
    }
  }
}

// A person is believed, but what the fibula says against it is not forgotten.
TEST(BoneImport, ASideThatIsSaidAgainstTheFibulaStaysADoubt) {
  BoneImport import;
  import.bones.resize(1);
  import.side = bones::Side::Left;
  import.side_source = SideSource::Fibula;
  import.side_by_fibula = bones::Side::Left;
  say_side(import, bones::Side::Left);
  EXPECT_TRUE(doubts_of_first(import).empty());
  EXPECT_EQ(import.side_source, SideSource::Fibula);
  say_side(import, bones::Side::Right);
  EXPECT_EQ(import.side, bones::Side::Right);
  EXPECT_THAT(doubts_of_first(import), ElementsAre(HasSubstr("as in a left knee, but the side is right")));
  EXPECT_TRUE(side_is_contradicted(import));
  say_side(import, bones::Side::Left);
  EXPECT_TRUE(doubts_of_first(import).empty()) << "what was said by mistake is no doubt";
  EXPECT_FALSE(side_is_contradicted(import));
}

// The fibula is heard where a name told the same side before it, too.
TEST(BoneImport, WhatTheFibulaSaysIsKeptBesideAName) {
  BoneImport import;
  import.bones.resize(1);
  import.side = Side::Left;
  import.side_source = SideSource::SourceName;
  import.side_by_fibula = Side::Left;
  say_side(import, Side::Right);
  EXPECT_THAT(doubts_of_first(import), ElementsAre(HasSubstr("as in a left knee, but the side is right")));
  EXPECT_TRUE(side_is_contradicted(import));
}

// One bone alone in a CT is a doubt, and no reason not to look at its shape.
TEST(BoneImport, ABoneThatIsAloneInItsImagesIsHeldAgainstItsSide) {
  const TemporaryFolder folder;
  static const auto phantom = phantom::make_phantom_knee({.edge_length_mm = 1.5});  // a right knee
  test::KnownCtOptions coarse;
  coarse.spacing_mm = {0.8, 0.8, 1};
  images::Volume volume = test::known_ct({phantom.femur.mesh}, coarse);
  images::write_volume(folder / "knee.nrrd", volume);
  BoneImportOptions options;
  options.side = Side::Left;
  const BoneImport import = import_bones(folder / "knee.nrrd", options);
  ASSERT_EQ(import.bones.size(), 1U);
  EXPECT_THAT(doubts_of_first(import),
              ElementsAre("the volume shows no tibia",
                          HasSubstr("by the shape of the bone it is a right knee, but the side is left")));
  // Whoever needs a side is asked for it before that shape is looked at: alone it is not believed.
  bool is_looked_at = false;
  BoneImportOptions needing;
  needing.needs_side = true;
  const std::string refused = message_of<InvalidInput>([&] {
    (void)import_bones(folder / "knee.nrrd", needing, [&](const ImportProgress& progress) {
      is_looked_at = is_looked_at || progress.stage == ImportStage::LookingAtBones;
    });
  });
  EXPECT_THAT(refused, HasSubstr("no tibia is seen, beside which a fibula would lie; the shape of one bone "
                                 "alone does not tell it surely"));
  EXPECT_FALSE(is_looked_at);
  const BoneImport unasked = import_bones(folder / "knee.nrrd");
  EXPECT_EQ(unasked.side, std::nullopt);
  EXPECT_NE(refused.find(unasked.why_no_side), std::string::npos) << unasked.why_no_side;
}

// Of an MR that says no modality and has no more grey values than a label map could have.
TEST(BoneImport, AnImageOfEightBitsIsNoLabelMap) {
  const TemporaryFolder folder;
  images::Volume volume = two_blocks();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 3);
  for (std::size_t i = 0; i < volume.values.size(); ++i) {
    const bool is_background = i % 40 < 15;
    const double grey = 60 + 3 * static_cast<double>(i / 1600) + noise(random);
    volume.values[i] = is_background ? 0.0F : static_cast<float>(std::clamp(std::round(grey), 1.0, 255.0));
  }
  ASSERT_GT(images::labels_of(volume).size(), 40U);
  EXPECT_FALSE(images::is_label_map(volume));
  images::write_volume(folder / "left_mr.nrrd", volume);
  BoneImportOptions options;
  options.images_only = true;
  const BoneImport import = import_bones(folder / "left_mr.nrrd", options);
  ASSERT_TRUE(import.image.has_value());
  EXPECT_FALSE(import.image->image.is_label_map);
  // As many labels as a whole body has, in blocks.
  for (std::size_t i = 0; i < volume.values.size(); ++i)
    volume.values[i] = static_cast<float>(i / 8 % 5 + 5 * (i / 1600 / 2));
  ASSERT_GT(images::labels_of(volume).size(), 40U);
  EXPECT_TRUE(images::is_label_map(volume));
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

// Into a pipe nobody may ever write: it is refused as what it is, whatever its name lacks.
TEST(BoneImport, APipeIsRefusedAsOne) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "bone.stl").c_str(), 0600), 0);
  EXPECT_THAT(message_of<IoError>([&] { (void)import_bones(folder / "bone.stl"); }),
              HasSubstr("bone.stl: is a pipe"));
  EXPECT_THAT(
      message_of<IoError>([&] { refuse_missing_side(folder / "new.arthro", folder / "bone.stl", {}); }),
      HasSubstr("bone.stl: is a pipe"));
}

}  // namespace
}  // namespace arthronaut::importing
