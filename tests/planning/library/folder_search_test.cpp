#include "planning/library/folder_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

TEST(FolderSearch, FindsCasesHoweverDeepAndOnceEach) {
  const test::TemporaryFolder folder;
  const fs::path root = fs::canonical(folder.path());
  test::make_case(root / "A.arthro");
  test::make_case(root / "A.arthro" / "inner.arthro");  // not looked into
  fs::create_directories(root / "x" / "y");
  test::make_case(root / "x" / "y" / "B.arthro");
  fs::create_directories(root / ".hidden");
  test::make_case(root / ".hidden" / "C.arthro");
  test::make_case(root / "no_ending");
  fs::create_directories(root / "empty.arthro");
  fs::create_directory_symlink(root / "x", root / "link");
  fs::create_directory_symlink(root, root / "x" / "round");
  EXPECT_THAT(find_case_folders(root), ElementsAre(root / "A.arthro", root / "x" / "y" / "B.arthro"));
  EXPECT_THAT(find_case_folders(root / "no_ending"), ElementsAre(root / "no_ending")) << "when it is named";
  EXPECT_THAT(find_case_folders(root / "empty.arthro"), ElementsAre());
}

TEST(FolderSearch, RefusesWhatIsNoFolder) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)find_case_folders(folder / "none"), IoError);
  test::write_text(folder / "file", "");
  EXPECT_THROW((void)find_case_folders(folder / "file"), IoError);
}

}  // namespace
}  // namespace arthronaut::library
