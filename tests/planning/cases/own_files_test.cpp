#include "planning/cases/own_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

namespace fs = std::filesystem;

TEST(OwnFiles, AreTheCasesAndNotWhatLiesBesideThem) {
  const test::TemporaryFolder folder;
  const fs::path knee = folder / "Knee.arthro";
  fs::create_directories(knee / "sessions/0001");
  std::ofstream(knee / "case.json");
  for (const char* own : {"case.json", "plan.json", "identity.json", "femur.ply", "camera.json",
                          "achieved.json", "sessions/0001/session.json", "painting/strokes.nrrd",
                          "screens/a.png", "pictures/a.png", "../Knee.arthro/plan.json"})
    EXPECT_TRUE(is_own_file(knee / own)) << own;
  for (const char* beside : {"report.pdf", "mine/plan.json", "../plan.json"})
    EXPECT_FALSE(is_own_file(knee / beside)) << beside;
  fs::create_directory_symlink(knee, folder / "link");
  EXPECT_TRUE(is_own_file(folder / "link/plan.json"));
}

}  // namespace
}  // namespace arthronaut::cases
