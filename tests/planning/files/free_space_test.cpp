#include "planning/files/free_space.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {
namespace {

TEST(FreeSpace, IsOfAFolderThatIsThere) {
  const test::TemporaryFolder folder;
  EXPECT_GT(free_bytes_at(folder.path()), 0U);
  EXPECT_THROW((void)free_bytes_at(folder / "missing"), IoError);
}

}  // namespace
}  // namespace arthronaut::files
