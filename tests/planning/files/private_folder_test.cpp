#include "planning/files/private_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {
namespace {

namespace fs = std::filesystem;

fs::perms rights_of(const fs::path& entry) { return fs::status(entry).permissions() & fs::perms::mask; }

class PrivateFolder : public ::testing::Test {
 protected:
  void SetUp() override { umask_ = ::umask(022); }  // as most systems have it
  void TearDown() override { ::umask(umask_); }
  mode_t umask_ = 0;
  test::TemporaryFolder temporary_;
};

TEST_F(PrivateFolder, IsItsOwnersAloneAndWhatIsAboveItIsNot) {
  create_private_folder(temporary_ / "above" / "private");
  EXPECT_EQ(rights_of(temporary_ / "above" / "private"), fs::perms{0700});
  EXPECT_EQ(rights_of(temporary_ / "above"), fs::perms{0755});
  EXPECT_TRUE(is_private(temporary_ / "above" / "private"));
  EXPECT_FALSE(is_private(temporary_ / "above"));
  EXPECT_FALSE(is_private(temporary_ / "absent"));
}

TEST_F(PrivateFolder, OneThatIsThereBecomesPrivate) {
  fs::create_directory(temporary_ / "open");
  create_private_folder(temporary_ / "open");
  EXPECT_TRUE(is_private(temporary_ / "open"));
}

TEST_F(PrivateFolder, WhatIsNoFolderIsSaid) {
  std::ofstream(temporary_ / "file") << "x";
  EXPECT_THAT(test::message_of<IoError>([&] { create_private_folder(temporary_ / "file"); }),
              ::testing::HasSubstr("not a folder"));
  EXPECT_THROW(create_private_folder(temporary_ / "file" / "within"), IoError);
}

// Files are no more open than their folder, and no less: a report on the desktop can be read as any file.
TEST_F(PrivateFolder, GivesItsRightsToTheFilesWrittenIntoIt) {
  create_private_folder(temporary_ / "private");
  for (const auto& folder : {temporary_ / "private", temporary_.path()}) {
    write_atomically(folder / "text", std::string_view("x"));
    write_atomically(folder / "own", [](const fs::path& temporary) { std::ofstream(temporary) << "x"; });
    const auto wanted = is_private(folder) ? fs::perms{0600} : fs::perms{0644};
    EXPECT_EQ(rights_of(folder / "text"), wanted);
    EXPECT_EQ(rights_of(folder / "own"), wanted);
  }
}

// Rights are taken, none is given.
TEST_F(PrivateFolder, MendingGivesNobodyARight) {
  const fs::path folder = temporary_ / "case";
  fs::create_directories(folder / "sub");
  std::ofstream(folder / "sub" / "read_only") << "x";
  fs::permissions(folder / "sub" / "read_only", fs::perms{0444});
  make_private(folder);
  EXPECT_EQ(rights_of(folder / "sub"), fs::perms{0700});
  EXPECT_EQ(rights_of(folder / "sub" / "read_only"), fs::perms{0400});
  make_private(temporary_ / "absent");  // nothing happens
}

}  // namespace
}  // namespace arthronaut::files
