#include "navigation/sources/source_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::TemporaryFolder;

// By extension in either case, by name, and files alone.
TEST(SourceFiles, AreListedByKindAndName) {
  const TemporaryFolder folder;
  for (const char* name : {"b.PNG", "a.jpg", "c.mp4", "d.MKV", "e.txt", "png"})
    std::ofstream(folder / name) << "x";
  std::filesystem::create_directories(folder / "folder.png");
  const std::filesystem::path path = (folder / "e.txt").parent_path();
  EXPECT_EQ(pictures_in(path), (std::vector<std::filesystem::path>{folder / "a.jpg", folder / "b.PNG"}));
  EXPECT_EQ(videos_in(path), (std::vector<std::filesystem::path>{folder / "c.mp4", folder / "d.MKV"}));
  EXPECT_TRUE(videos_in(folder / "absent").empty());
  EXPECT_TRUE(looks_like_picture("x.webp"));
  EXPECT_FALSE(looks_like_picture("x.mov"));
}

}  // namespace
}  // namespace arthronaut::sources
