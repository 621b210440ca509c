#include "app/start/import_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

using bones::BoneKind;
using State = ImportWork::State;

const cases::Case& knee() {
  static const cases::Case made = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "test");
  return made;
}

class ImportWorkTest : public ::testing::Test {
 protected:
  void write_meshes(const std::string& femur, const std::string& tibia) const {
    bones::write_mesh_stl(folder_ / femur, knee().bones.at(BoneKind::Femur).mesh);
    bones::write_mesh_stl(folder_ / tibia, knee().bones.at(BoneKind::Tibia).mesh);
  }
  // Of every slice the first so many pixels alone.
  void write_slices(const std::string& name, const std::string& uid, std::size_t pixels = 35) const {
    std::filesystem::create_directories(folder_ / name);
    for (auto& [file, slice] : test::dicom_slices(test::oblique_volume())) {
      test::DicomSliceForm form = slice;
      form.series_uid = uid;
      form.stored.resize(pixels);
      test::write_bytes(folder_ / name / file, test::dicom(form));
    }
  }
  // As the window does, frame after frame; slow machines are waited for.
  template <typename Condition>
  static bool reach(ImportWork& work, const Condition& is_so) {
    for (int i = 0; i < 12'000 && !is_so(); ++i) {
      work.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return is_so();
  }
  bool reach(State state) {
    return reach(work_, [&] { return work_.state() == state; });
  }
  const test::TemporaryFolder folder_;
  ImportWork work_{[] {}, ARTHRONAUT_PROGRAM};
};

// A file without a byte is listed with that reason, whatever its name says.
TEST_F(ImportWorkTest, AnEmptyMeshIsSaidToBeEmpty) {
  test::write_bytes(folder_ / "femur.stl", "");
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  ASSERT_EQ(work_.sources().sources.size(), 1U);
  EXPECT_EQ(work_.sources().sources[0].refusal, "the file is empty");
}

// From a folder with two meshes to a case with two bones; the side that no name tells is asked for and the
// case is not written before.
TEST_F(ImportWorkTest, MakesACaseOfTwoMeshesAndAsksForTheSide) {
  write_meshes("femur.stl", "tibia.stl");
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  ASSERT_EQ(work_.sources().sources.size(), 2U);
  EXPECT_EQ(work_.sources().sources[0].bone, BoneKind::Femur);
  work_.start({.sources = {0, 1}});
  ASSERT_TRUE(reach(State::Asking)) << work_.failure();
  EXPECT_EQ(work_.result().bones.size(), 2U);
  const auto target = new_case_folder(folder_ / "cases", "Knee");
  if (!work_.result().side) {
    work_.save(target, "Knee");
    EXPECT_EQ(work_.state(), State::Asking) << "without a side nothing is written";
  }
  const auto found = work_.result().side;
  work_.set_side(bones::Side::Left);  // by mistake
  EXPECT_EQ(work_.result().side, found) << "what is said takes nothing from what was found";
  work_.set_side(bones::Side::Right);
  work_.save(target, "Knee");
  ASSERT_TRUE(reach(State::Done)) << work_.failure();
  const cases::Case made = cases::load_case(work_.folder());
  EXPECT_EQ(made.side, bones::Side::Right);
  EXPECT_EQ(made.bones.size(), 2U);
  EXPECT_NE(new_case_folder(folder_ / "cases", "Knee"), target) << "the next one gets a folder of its own";
}

// One bar for all that is imported: it does not begin anew with the second mesh.
TEST_F(ImportWorkTest, TheBarNeverGoesBack) {
  write_meshes("right_femur.stl", "right_tibia.stl");
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0, 1}});
  double before = 0, at_second = 0;
  const auto follow = [&] {
    EXPECT_GE(work_.done_fraction(), before);
    before = work_.done_fraction();
    if (at_second == 0 && work_.result().bones.size() == 1) at_second = before;
    return work_.state() == State::Asking;
  };
  ASSERT_TRUE(reach(work_, follow)) << work_.failure();
  EXPECT_GE(at_second, 0.4) << "half of two meshes";
  EXPECT_LE(at_second, 0.5);
  EXPECT_GT(before, 0.9);
  EXPECT_LE(before, 1);
}

// That both knees are there is told by the import, not by words that a folder's name may have, too.
TEST_F(ImportWorkTest, BothKneesAreToldByWhatTheImagesShow) {
  write_slices("shows both knees", "1.2.3");
  work_.look_into(folder_ / "shows both knees");
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0}});
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_THAT(work_.failure(), testing::HasSubstr("shows both knees"));
  EXPECT_NE(work_.refusal().reason, importing::FailureReason::ShowsBothKnees);
}

// Names that tell the side are believed, and that they were is said; meshes of two sides are no knee.
TEST_F(ImportWorkTest, MeshesOfTwoSidesAreRefused) {
  write_meshes("right_femur.stl", "left_tibia.stl");
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0, 1}});
  for (int i = 0; i < 12'000 && work_.state() == State::Running; ++i) {
    work_.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(work_.state(), State::Choosing);
  EXPECT_NE(work_.failure().find("different sides"), std::string::npos) << work_.failure();
}

// Meshes in metres are made once a person has said so, of each that needs it; one beside it may be in mm. And
// of a mesh whose name tells nothing it is said which bone it is.
TEST_F(ImportWorkTest, AsksForTheUnitAndTheBoneOfAMesh) {
  write_meshes("part_1.stl", "tibia.stl");
  bones::Bone femur = knee().bones.at(BoneKind::Femur);
  for (auto& vertex : femur.mesh.vertices_mm) vertex /= 1000;
  bones::write_mesh_stl(folder_ / "part_1.stl", femur.mesh);
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  ASSERT_FALSE(work_.sources().sources[0].can_be_imported());
  work_.set_bone(0, BoneKind::Femur);
  ASSERT_TRUE(work_.sources().sources[0].can_be_imported());
  work_.start({.sources = {0, 1}});
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_EQ(work_.refusal().reason, importing::FailureReason::NeedsUnit) << work_.failure();
  EXPECT_THAT(work_.refusal().units, testing::ElementsAre(bones::LengthUnit::Metre));
  EXPECT_EQ(work_.refused_source(), &work_.sources().sources[0]);
  work_.start({.sources = {0, 1}, .unit = bones::LengthUnit::Metre});
  ASSERT_TRUE(reach(State::Asking)) << work_.failure();
  ASSERT_EQ(work_.result().bones.size(), 2U);
  for (const auto& made : work_.result().bones)
    EXPECT_NEAR(geometry::bounds_of(made.bone.mesh).size_mm().norm(),
                geometry::bounds_of(knee().bones.at(made.bone.kind).mesh).size_mm().norm(), 0.01);
}

// Meshes in RAS that do not say so lie the wrong way round; a person who says so gets them as they are in the
// patient, and nothing else of the import is asked for again.
TEST_F(ImportWorkTest, SwapsTheAxesOfMeshesThatLookBackwards) {
  for (const auto& [kind, name] : {std::pair(BoneKind::Femur, "femur.stl"), {BoneKind::Tibia, "tibia.stl"}}) {
    geometry::TriangleMesh mesh = knee().bones.at(kind).mesh;
    for (auto& vertex : mesh.vertices_mm) vertex.head<2>() *= -1;
    bones::write_mesh_stl(folder_ / name, mesh);
  }
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0, 1}});
  ASSERT_TRUE(reach(State::Asking)) << work_.failure();
  ASSERT_TRUE(work_.can_swap_axes());
  work_.swap_axes();
  ASSERT_TRUE(reach(State::Asking)) << work_.failure();
  EXPECT_FALSE(work_.can_swap_axes());
  ASSERT_EQ(work_.result().bones.size(), 2U);
  for (const auto& made : work_.result().bones) {
    EXPECT_EQ(made.read_in, bones::Space::RAS);
    EXPECT_LT((geometry::bounds_of(made.bone.mesh).center_mm() -
               geometry::bounds_of(knee().bones.at(made.bone.kind).mesh).center_mm())
                  .norm(),
              0.01);
  }
}

// The side that the second mesh's name tells is a guess as well as the first one's.
TEST_F(ImportWorkTest, HowTheSideIsKnownComesWithIt) {
  write_meshes("femur.stl", "tibia_left.stl");
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0, 1}});
  ASSERT_TRUE(reach(State::Asking)) << work_.failure();
  if (work_.result().side_source == importing::SideSource::Shapes)
    GTEST_SKIP() << "the femur tells its side by itself";
  EXPECT_EQ(work_.result().side, bones::Side::Left);
  EXPECT_EQ(work_.result().side_source, importing::SideSource::SourceName);
}

// A file that is broken is refused with its reason, and something else can be chosen; a cancelled import
// leaves nothing.
TEST_F(ImportWorkTest, RefusalAndCancelLeadBackToTheChoice) {
  write_meshes("right_femur.stl", "right_tibia.stl");
  std::ofstream(folder_ / "right_femur.stl") << "solid cut off\nfacet normal 0 0";
  work_.look_into(folder_.path());
  ASSERT_TRUE(reach(State::Choosing));
  work_.start({.sources = {0}});
  ASSERT_EQ(work_.state(), State::Running);
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_NE(work_.failure().find("femur.stl"), std::string::npos) << work_.failure();
  work_.start({.sources = {1}});
  work_.cancel();
  EXPECT_EQ(work_.state(), State::Choosing);
  EXPECT_EQ(work_.failure(), "");
}

// The list first, then a picture of each series, the same as made here; a series whose pixels are cut off has
// none, and the reason is told.
TEST_F(ImportWorkTest, ListsTheSeriesAndThenShowsThem) {
  write_slices("disc/whole", "1.2.3.4");
  write_slices("disc/cut", "1.2.3.5", 10);
  work_.look_into(folder_ / "disc");
  EXPECT_EQ(work_.thumbnail(0), nullptr);
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_EQ(work_.failure(), "");
  const images::SeriesList here = images::find_series(folder_ / "disc");
  ASSERT_EQ(work_.sources().sources.size(), 2U);
  EXPECT_EQ(work_.sources().sources[0].series->uid, "1.2.3.4");
  EXPECT_EQ(work_.sources().sources[0].series->files, here.series[0].files);
  ASSERT_TRUE(reach(work_, [&] { return !work_.makes_pictures(); }));
  ASSERT_NE(work_.thumbnail(0), nullptr);
  const images::Thumbnail made = images::thumbnail_of(here.series[0]);
  EXPECT_EQ(work_.thumbnail(0)->width, made.width);
  EXPECT_EQ(work_.thumbnail(0)->grey, made.grey);
  EXPECT_EQ(work_.sources().sources[0].warnings, here.series[0].warnings);
  EXPECT_EQ(work_.thumbnail(1), nullptr);
  EXPECT_THAT(work_.sources().sources[1].warnings.at(0),
              testing::AllOf(testing::StartsWith("No picture: "), testing::HasSubstr("end early")));
}

// A folder of slices in a file dialog: one is clicked on, and its series is meant. It was a dead end.
TEST_F(ImportWorkTest, OneSliceStandsForItsSeries) {
  write_slices("disc", "1.2.3.4");
  write_slices("disc/more", "1.2.3.5");
  const auto slice = *std::filesystem::directory_iterator(folder_ / "disc" / "more");
  work_.look_into(slice.path());
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_EQ(work_.failure(), "");
  EXPECT_EQ(work_.sources().root, folder_ / "disc" / "more");
  ASSERT_TRUE(work_.sources().best());
  const ImportSource& taken = work_.sources().sources.at(*work_.sources().best());
  EXPECT_EQ(taken.series->uid, "1.2.3.5");
  EXPECT_GT(taken.series->image_count, 1);
  EXPECT_TRUE(taken.can_be_imported()) << taken.refusal;
}

// Of a folder with several the one that was chosen is taken, and no other where it cannot be.
TEST(ImportSources, TheSeriesThatWasChosenIsTheOneToBeginWith) {
  ImportSources found;
  for (const char* uid : {"1.1", "1.2"}) {
    ImportSource source;
    source.series = images::ImageSeries{};
    source.series->uid = uid;
    source.series->modality = uid == std::string("1.1") ? "CT" : "MR";
    found.sources.push_back(source);
  }
  EXPECT_EQ(found.best(), 0U);
  found.wanted_uid = "1.2";
  EXPECT_EQ(found.best(), 1U);
  found.sources[1].refusal = "holds one slice only";
  EXPECT_FALSE(found.best());
}

// Whatever ends the process that looks: it is said, meshes are listed all the same, and the next look is as
// ever.
TEST_F(ImportWorkTest, AProcessThatDiesWhileLookingIsAReasonAndNoHarm) {
  write_meshes("right_femur.stl", "right_tibia.stl");
  ImportWork work([] {}, "/bin/false");
  work.look_into(folder_.path());
  ASSERT_TRUE(reach(work, [&] { return work.state() == State::Choosing; }));
  EXPECT_THAT(work.failure(),
              testing::AllOf(testing::HasSubstr(folder_.path().string()), testing::HasSubstr("code 1")));
  EXPECT_EQ(work.sources().sources.size(), 2U);
  EXPECT_FALSE(work.makes_pictures());
  // No program at all.
  ImportWork without([] {}, folder_ / "absent");
  without.look_into(folder_.path());
  ASSERT_TRUE(reach(without, [&] { return without.state() == State::Choosing; }));
  EXPECT_THAT(without.failure(), testing::HasSubstr("cannot be started"));
}

// One that hangs is left by cancel, in no time.
TEST_F(ImportWorkTest, CancelLeavesAProcessThatHangs) {
  test::write_bytes(folder_ / "hang.sh", "#!/bin/sh\nexec sleep 60\n");
  std::filesystem::permissions(folder_ / "hang.sh", std::filesystem::perms{0755});
  ImportWork work([] {}, folder_ / "hang.sh");
  const auto start = std::chrono::steady_clock::now();
  work.look_into(folder_.path());
  for (int i = 0; i < 10; ++i) work.poll();
  EXPECT_EQ(work.state(), State::Looking);
  EXPECT_TRUE(work.is_busy());
  work.cancel();
  EXPECT_EQ(work.state(), State::Idle);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

// Looking somewhere else forgets what was found; a folder without anything says so by an empty list; one that
// is not there by a reason.
TEST_F(ImportWorkTest, LooksAnew) {
  write_meshes("right_femur.stl", "right_tibia.stl");
  work_.look_into(folder_.path());
  work_.look_into(folder_ / "absent");
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_TRUE(work_.sources().sources.empty());
  EXPECT_NE(work_.failure(), "");
  std::filesystem::create_directory(folder_ / "empty");
  work_.look_into(folder_ / "empty");
  ASSERT_TRUE(reach(State::Choosing));
  EXPECT_TRUE(work_.sources().sources.empty());
  EXPECT_FALSE(work_.sources().best());
}

TEST(NewCaseFolder, HasNoCharactersThatFileSystemsLack) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(new_case_folder(folder.path(), "a/b: c").filename(), "a-b- c.arthro");
  EXPECT_EQ(new_case_folder(folder.path(), "").filename(), "Knee.arthro");
  EXPECT_EQ(new_case_folder(folder.path(), "..").filename(), "-..arthro");
}

}  // namespace
}  // namespace arthronaut::start
