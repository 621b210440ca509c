#include "app/review/postop_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A decoder that crashes on what a hospital's disc holds ends the process that reads, and that is told.
TEST(PostopRun, Hazard18AFileThatEndsItsReaderEndsNothingElse) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "disc");
  std::ofstream(folder / "disc/IM0001") << "no image";
  std::ofstream(folder / "reader") << "#!/bin/sh\nkill -SEGV $$\n";
  fs::permissions(folder / "reader", fs::perms::owner_all);
  PostopRun run(
      folder / "Knee.arthro", folder / "disc", "", false, [] {}, folder / "reader");
  for (int i = 0; i < 3000 && !run.has_ended(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(run.has_ended());
  EXPECT_THAT(run.error(), HasSubstr("ended the importing process"));
}

}  // namespace
}  // namespace arthronaut::review
