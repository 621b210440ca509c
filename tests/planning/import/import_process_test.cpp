#include "planning/import/import_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>

#include "planning/geometry/error.h"
#include "planning/images/volume_decoder.h"
#include "planning/images/volume_writer.h"
#include "planning/import/label_choice.h"
#include "planning/postop/postop_source.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/images/large_volume.h"
#include "tests/planning/import/child_script.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;
using bones::Side;
using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using State = ImportProcess::State;

class ImportProcessTest : public testing::Test {
 protected:
  [[nodiscard]] ImportRequest request(const std::filesystem::path& source) const {
    ImportRequest request;
    request.source = source;
    request.program = ARTHRONAUT_IMPORT_CHILD;
    return request;
  }
  [[nodiscard]] std::filesystem::path script(const std::string& line) const {
    return test::child_script(folder_.path(), line);
  }
  static State finished(ImportProcess& process) {
    while (process.wait_for(60) == State::Running) {
    }
    return process.state();
  }

  TemporaryFolder folder_;
};

bool is_gone(int process_id) { return ::kill(process_id, 0) != 0; }

// Bit for bit what the same import gives within this process.
TEST_F(ImportProcessTest, GivesTheSameBonesAsAnImportInThisProcess) {
  geometry::TriangleMesh mesh = test::ellipsoid({40, 30, 25}, 3, {-30, 0, 0});
  mesh.triangles.pop_back();
  test::write_bytes(folder_ / "right_femur.stl", test::binary_stl(mesh));
  ImportProcess process(request(folder_ / "right_femur.stl"));
  ASSERT_EQ(finished(process), State::Done) << process.message();
  const BoneImport apart = process.take_result(), here = import_bones(folder_ / "right_femur.stl");
  ASSERT_EQ(apart.bones.size(), 1U);
  EXPECT_EQ(apart.bones[0].bone.mesh.vertices_mm, here.bones[0].bone.mesh.vertices_mm);
  EXPECT_EQ(apart.bones[0].bone.mesh.triangles, here.bones[0].bone.mesh.triangles);
  EXPECT_EQ(apart.bones[0].bone.kind, BoneKind::Femur);
  EXPECT_EQ(apart.bones[0].bone.source, here.bones[0].bone.source);
  EXPECT_EQ(apart.bones[0].lines, here.bones[0].lines);
  EXPECT_EQ(apart.bones[0].doubts, here.bones[0].doubts);
  EXPECT_EQ(apart.bones[0].repair.holes_filled, 1U);
  EXPECT_TRUE(apart.bones[0].repair.is_closed);
  EXPECT_EQ(apart.side, Side::Right);
  EXPECT_EQ(apart.side_source, SideSource::SourceName);
  EXPECT_EQ(apart.lines, here.lines);
}

// Whose images they were comes along, text by text.
TEST_F(ImportProcessTest, TheStudyComesAlong) {
  const test::DicomSeriesForm form;
  test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct(), form);
  ImportRequest asked = request(folder_ / "ct");
  asked.options.kind = BoneKind::Femur;
  asked.options.threshold = 300;
  ImportProcess process(asked);
  ASSERT_EQ(finished(process), State::Done) << process.message();
  BoneImport import = process.take_result();
  EXPECT_EQ(import.identity, (cases::Identity{"Muster^Anna", "4711", "19900131"}));
  EXPECT_EQ(import.origin.sop_instance_uids.size(), 44U);
  import.origin.sop_instance_uids.clear();
  EXPECT_EQ(import.origin, form.origin);
  import.forget_patient();
  EXPECT_TRUE(import.origin.is_empty() && import.identity.is_empty());
}

// Images after an operation come as they are read here, and whose they are.
TEST_F(ImportProcessTest, Hazard18ReadsTheImagesAfterAnOperation) {
  const test::DicomSeriesForm form;
  test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct(), form);
  ImportRequest asked = request(folder_ / "ct");
  asked.is_postop = true;
  ImportProcess process(asked);
  ASSERT_EQ(finished(process), State::Done) << process.message();
  const BoneImport read = process.take_result();
  EXPECT_TRUE(read.bones.empty());
  EXPECT_EQ(read.identity, (cases::Identity{"Muster^Anna", "4711", "19900131"}));
  ASSERT_TRUE(read.image);
  const images::Volume apart = images::volume_of(read.image->volume),
                       here = postop::read_postop(folder_ / "ct");
  EXPECT_EQ(apart.values, here.values);
  EXPECT_EQ(apart.size, here.size);
  EXPECT_EQ(apart.modality, images::Modality::Ct);
  EXPECT_TRUE(apart.lps_from_index.isApprox(here.lps_from_index, 1e-9));
}

// Every option arrives: without one of them the bone would be another, or none.
TEST_F(ImportProcessTest, PassesTheOptionsOn) {
  test::write_bytes(folder_ / "bone.stl",
                    test::binary_stl(test::ellipsoid({0.04, 0.03, 0.025}, 3, {0.03, 0, 0})));
  ImportRequest asked = request(folder_ / "bone.stl");
  asked.options.kind = BoneKind::Tibia;
  asked.options.side = Side::Left;
  asked.options.unit = bones::LengthUnit::Metre;
  asked.options.space = bones::Space::RAS;
  ImportProcess process(asked);
  ASSERT_EQ(finished(process), State::Done) << process.message();
  const BoneImport import = process.take_result();
  EXPECT_EQ(import.bones.at(0).bone.kind, BoneKind::Tibia);
  EXPECT_EQ(import.side, Side::Left);
  EXPECT_FALSE(is_guess(import.side_source));
  // 30 mm to the right in a RAS file is at -30 mm in LPS; floats of the STL carry it to 1e-5 mm.
  EXPECT_NEAR(geometry::bounds_of(import.bones[0].bone.mesh).center_mm().x(), -30, 1e-3);
}

TEST_F(ImportProcessTest, TellsHowFarItIs) {
  test::write_bytes(folder_ / "knee.nrrd", test::uniform_nrrd({100, 100, 100}, 700));
  ImportRequest asked = request(folder_ / "knee.nrrd");
  asked.options.threshold = 300;
  ImportProcess process(asked);
  double before = 0;
  while (process.wait_for(60) == State::Running) {
    EXPECT_GE(process.done_fraction(), before) << in_words(process.progress().stage);
    before = process.done_fraction();
  }
  EXPECT_EQ(process.state(), State::Done) << process.message();
  EXPECT_GT(process.done_fraction(), 0.85);
  // Quick stages may pass between two looks; the last one that was told stays.
  EXPECT_EQ(process.progress().stage, ImportStage::LookingAtBones);
}

TEST_F(ImportProcessTest, ARefusalComesBackWithFilePlaceAndReason) {
  test::write_bytes(folder_ / "right_femur.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n");
  ImportProcess process(request(folder_ / "right_femur.stl"));
  ASSERT_EQ(finished(process), State::Failed);
  EXPECT_EQ(process.message(),
            message_of<InvalidInput>([&] { (void)import_bones(folder_ / "right_femur.stl"); }));
  ImportProcess absent(request(folder_ / "absent.stl"));
  ASSERT_EQ(finished(absent), State::Failed);
  EXPECT_THAT(absent.message(), HasSubstr("absent.stl: does not exist"));
}

// What a person can be asked, which of two knees is meant or strokes in an MR, is told apart from what is
// merely refused.
TEST_F(ImportProcessTest, ReasonsThatCanBeAnsweredAreToldApart) {
  const images::Volume one = test::ellipsoid_ct();
  images::Volume both = one;
  const auto across = static_cast<int>(150 / one.spacing_mm().x());  // from knee to knee
  both.size.x() += across;
  both.values.assign(static_cast<std::size_t>(both.size.prod()), -100.0F);
  for (int k = 0; k < one.size.z(); ++k)
    for (int j = 0; j < one.size.y(); ++j)
      for (int i = 0; i < one.size.x(); ++i)
        for (const int at : {i, i + across})
          both.values[both.index(at, j, k)] = std::max(both.values[both.index(at, j, k)], one.at(i, j, k));
  test::write_dicom_series(folder_ / "ct", both);
  ImportProcess process(request(folder_ / "ct"));
  ASSERT_EQ(finished(process), State::Failed);
  EXPECT_EQ(process.failure().reason, FailureReason::ShowsBothKnees);
  EXPECT_THAT(process.message(), AllOf(HasSubstr((folder_ / "ct").string()), HasSubstr("--side")));
  test::write_bytes(folder_ / "mr.nrrd", test::uniform_nrrd({20, 20, 20}, 700));  // no air of -1000 HU
  ImportProcess mr(request(folder_ / "mr.nrrd"));
  ASSERT_EQ(finished(mr), State::Failed);
  EXPECT_EQ(mr.failure().reason, FailureReason::IsNoCt) << mr.message();
  test::write_dicom_series(folder_ / "shows both knees", one);
  ImportRequest asked = request(folder_ / "shows both knees");
  asked.options.threshold = 3000;
  ImportProcess other(asked);
  ASSERT_EQ(finished(other), State::Failed);
  EXPECT_EQ(other.failure().reason, FailureReason::Other);
}

// With what may be answered: the units in which the mesh is a bone, and the labels with their sizes. A mesh
// that is none in any unit is merely refused.
TEST_F(ImportProcessTest, UnitsAndLabelsThatAreNotSaidAreAskedFor) {
  test::write_bytes(folder_ / "femur.stl", test::binary_stl(test::ellipsoid({0.04, 0.03, 0.025}, 2)));
  ImportProcess metres(request(folder_ / "femur.stl"));
  ASSERT_EQ(finished(metres), State::Failed);
  EXPECT_EQ(metres.failure().reason, FailureReason::NeedsUnit) << metres.message();
  EXPECT_THAT(metres.failure().units, testing::ElementsAre(bones::LengthUnit::Metre));
  EXPECT_NEAR(metres.failure().size_in_file, 0.08, 1e-6);
  test::write_bytes(folder_ / "femur.stl", test::binary_stl(test::ellipsoid({4e-6, 3e-6, 2e-6}, 2)));
  ImportProcess tiny(request(folder_ / "femur.stl"));
  ASSERT_EQ(finished(tiny), State::Failed);
  EXPECT_EQ(tiny.failure().reason, FailureReason::Other);

  images::Volume map;
  map.size = {20, 30, 40};
  map.lps_from_index.linear() = Eigen::Vector3d(1, 2, 1).asDiagonal();
  map.values.assign(static_cast<std::size_t>(map.size.prod()), 0.0F);
  const auto fill = [&](float label, int from, int to) {
    for (int k = from; k < to; ++k)
      for (int j = 5; j < 25; ++j)
        for (int i = 5; i < 15; ++i) map.values[map.index(i, j, k)] = label;
  };
  fill(3, 2, 12);
  fill(4, 13, 15);
  fill(8, 16, 36);
  images::write_volume(folder_ / "map.nrrd", map);
  ImportProcess labels(request(folder_ / "map.nrrd"));
  ASSERT_EQ(finished(labels), State::Failed);
  ASSERT_EQ(labels.failure().reason, FailureReason::NeedsLabels) << labels.message();
  const std::vector<FoundLabel>& found = labels.failure().labels;
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[2].label, 8);
  EXPECT_NEAR(found[2].volume_cm3, 10 * 20 * 20 * 2 / 1000.0, 1e-9);
  EXPECT_EQ(found[2].lowest_mm, Eigen::Vector3d(5, 10, 16));
  EXPECT_EQ(found[2].highest_mm, Eigen::Vector3d(14, 48, 35));
  EXPECT_EQ(likely_labels(found), (std::map<BoneKind, int>{{BoneKind::Femur, 8}, {BoneKind::Tibia, 3}}));
  EXPECT_TRUE(likely_labels({found[0]}).empty());
}

// Its header is within the limit, what is made of it is not: 15.6 million voxels, all of them bone.
TEST_F(ImportProcessTest, AVolumeThatNeedsTooMuchMemoryIsAClearErrorAndNoHarm) {
  test::write_bytes(folder_ / "bomb.nrrd", test::uniform_nrrd({250, 250, 250}, 700));
  ImportRequest asked = request(folder_ / "bomb.nrrd");
  asked.options.kind = BoneKind::Femur;
  asked.options.threshold = 300;
  asked.memory_limit_gib = 0.1;
  ImportProcess process(asked);
  EXPECT_EQ(finished(process), State::Failed);
  EXPECT_THAT(process.message(),
              AllOf(HasSubstr("bomb.nrrd: needs more than the 0.1 GiB"), HasSubstr("--memory-limit-gib")));
  EXPECT_THAT(folder_.names(), testing::ElementsAre("bomb.nrrd"));
}

// The header alone is told in the same way, with the limit of this import.
TEST_F(ImportProcessTest, AHeaderThatClaimsTooMuchIsRefusedByTheLimitOfTheImport) {
  test::write_bytes(folder_ / "bomb.nrrd", test::uniform_nrrd({250, 250, 250}, 700));
  ImportRequest asked = request(folder_ / "bomb.nrrd");
  asked.memory_limit_gib = 0.05;
  ImportProcess process(asked);
  EXPECT_EQ(finished(process), State::Failed);
  EXPECT_THAT(process.message(), AllOf(HasSubstr("250 x 250 x 250"), HasSubstr("limit is 0.05 GiB")));
}

TEST_F(ImportProcessTest, AChildThatIsKilledIsAClearError) {
  ImportRequest asked = request("knee.nrrd");
  asked.program = script("kill -9 $$");
  ImportProcess killed(asked);
  EXPECT_EQ(finished(killed), State::Failed);
  EXPECT_THAT(killed.message(), AllOf(HasSubstr("knee.nrrd: "), HasSubstr("signal 9")));
  asked.program = script("kill -SEGV $$");
  ImportProcess crashed(asked);
  EXPECT_EQ(finished(crashed), State::Failed);
  EXPECT_THAT(crashed.message(), HasSubstr("signal 11"));
  asked.program = script("exit 7");
  ImportProcess ended(asked);
  EXPECT_EQ(finished(ended), State::Failed);
  EXPECT_THAT(ended.message(), HasSubstr("code 7"));
}

// What it says is not believed.
TEST_F(ImportProcessTest, AChildThatTalksNonsenseIsAClearError) {
  ImportRequest asked = request("knee.nrrd");
  asked.program = script("exec head -c 100000 /dev/zero >&0");
  ImportProcess process(asked);
  EXPECT_EQ(finished(process), State::Failed);
  EXPECT_THAT(process.message(), AllOf(HasSubstr("knee.nrrd: "), HasSubstr("no message")));
  EXPECT_EQ(process.process_id(), -1);
}

TEST_F(ImportProcessTest, CancelEndsTheChildAtOnce) {
  ImportRequest asked = request("knee.nrrd");
  asked.program = script("exec sleep 60");
  const auto start = std::chrono::steady_clock::now();
  int process_id = -1;
  {
    ImportProcess process(asked);
    process_id = process.process_id();
    EXPECT_EQ(process.poll(), State::Running);
    EXPECT_FALSE(is_gone(process_id));
    process.cancel();
    EXPECT_EQ(process.poll(), State::Cancelled);
    EXPECT_THAT(process.message(), HasSubstr("cancelled"));
    EXPECT_TRUE(is_gone(process_id));
    EXPECT_THROW((void)process.take_result(), InvalidInput);
  }
  // So does letting go of it.
  {
    const ImportProcess process(asked);
    process_id = process.process_id();
  }
  EXPECT_TRUE(is_gone(process_id));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));  // it would sleep for 60
}

TEST_F(ImportProcessTest, WhatCannotBeStartedIsAnIoError) {
  ImportRequest asked = request("knee.nrrd");
  asked.program = folder_ / "absent";
  EXPECT_THAT(message_of<IoError>([&] { const ImportProcess process(asked); }), HasSubstr("absent"));
  asked = request("knee.nrrd");
  asked.memory_limit_gib = 0;
  EXPECT_THROW(ImportProcess{asked}, InvalidInput);
}

}  // namespace
}  // namespace arthronaut::importing
