#include "app/start/import_work.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
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
  // As the window does, frame after frame; slow machines are waited for.
  bool reach(State state) {
    for (int i = 0; i < 12'000 && work_.state() != state; ++i) {
      work_.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return work_.state() == state;
  }
  const test::TemporaryFolder folder_;
  ImportWork work_{[] {}, ARTHRONAUT_PROGRAM};
};

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
  work_.set_side(bones::Side::Right);
  work_.save(target, "Knee");
  ASSERT_TRUE(reach(State::Done)) << work_.failure();
  const cases::Case made = cases::load_case(work_.folder());
  EXPECT_EQ(made.side, bones::Side::Right);
  EXPECT_EQ(made.bones.size(), 2U);
  EXPECT_NE(new_case_folder(folder_ / "cases", "Knee"), target) << "the next one gets a folder of its own";
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
