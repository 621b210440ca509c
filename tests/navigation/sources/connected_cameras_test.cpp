#include "navigation/sources/connected_cameras.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

// Video devices alone, by number, with the name that the system has for them.
TEST(ConnectedCameras, ListsWhatTheSystemHas) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary / "dev";
  std::filesystem::create_directories(folder / "names" / "video2");
  for (const char* name : {"video10", "video2", "video", "videoX", "video3b", "null"})
    std::ofstream(folder / name) << "";
  std::ofstream(folder / "names" / "video2" / "name") << "Capture card\n";
  const auto cameras = connected_cameras(folder, folder / "names");
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].index, 2);
  EXPECT_EQ(cameras[0].name, "Capture card");
  EXPECT_EQ(cameras[1].index, 10);
  EXPECT_EQ(cameras[1].name, (folder / "video10").string());
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(connected_cameras(folder, folder).empty());
}

}  // namespace
}  // namespace arthronaut::sources
