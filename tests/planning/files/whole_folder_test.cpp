#include "planning/files/whole_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "tests/full_disk.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {
namespace {

namespace fs = std::filesystem;

bool is_alone(const fs::path& parent) { return fs::is_empty(parent); }

TEST(WholeFolder, AppearsWithAllThatIsInItAndIsItsOwnersAlone) {
  const test::TemporaryFolder parent;
  fs::path meanwhile;
  make_whole_folder(parent / "deep/wanted/", [&](const fs::path& unfinished) {
    meanwhile = unfinished;
    EXPECT_FALSE(fs::exists(parent / "deep/wanted"));
    std::ofstream(unfinished / "a") << "x";
  });
  EXPECT_TRUE(fs::exists(parent / "deep/wanted/a"));
  EXPECT_TRUE(is_private(parent / "deep/wanted"));
  EXPECT_FALSE(fs::exists(meanwhile));
}

// Whatever is thrown, nothing is left; what the disk says is said of the folder that was asked for.
TEST(WholeFolder, LeavesNothingWhenItCannotBeFilled) {
  const test::TemporaryFolder parent;
  const fs::path wanted = parent / "wanted";
  EXPECT_EQ(test::message_of<IoError>([&] {
              make_whole_folder(
                  wanted, [](const fs::path& unfinished) { throw IoError(unfinished / "a", "is full"); });
            }),
            (wanted / "a").string() + ": is full");
  EXPECT_TRUE(is_alone(parent.path()));
  EXPECT_THROW(make_whole_folder(wanted, [](const fs::path&) { throw std::logic_error("other"); }),
               std::logic_error);
  EXPECT_TRUE(is_alone(parent.path()));
}

TEST(WholeFolder, NeverTakesThePlaceOfOneThatHoldsSomething) {
  const test::TemporaryFolder parent;
  fs::create_directory(parent / "taken");
  std::ofstream(parent / "taken/mine") << "x";
  EXPECT_THROW(make_whole_folder(parent / "taken", [](const fs::path&) {}), IoError);
  EXPECT_TRUE(fs::exists(parent / "taken/mine"));
  EXPECT_EQ(std::distance(fs::directory_iterator(parent.path()), {}), 1);
}

// What somebody laid into a folder is his, also while it is filled.
TEST(WholeFolder, OneThatIsFilledKeepsWhatElseIsInIt) {
  const test::TemporaryFolder parent;
  const fs::path folder = parent / "there";
  fs::create_directory(folder);
  for (const char* name : {"mine", "a", "old", "both"}) std::ofstream(folder / name) << "before";
  fill_folder(folder / "",
              [&](const fs::path& unfinished) {
                EXPECT_EQ(unfinished.parent_path(), folder);
                for (const char* name : {"a", "both"}) std::ofstream(unfinished / name) << "new";
                std::ofstream(folder / "meanwhile") << "laid there";
              },
              {"old", "both", "never"});
  EXPECT_EQ(read_text(folder / "mine"), "before");
  EXPECT_EQ(read_text(folder / "meanwhile"), "laid there");
  EXPECT_EQ(read_text(folder / "a"), "new");
  EXPECT_EQ(read_text(folder / "both"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 4) << "mine, meanwhile, a and both";
}

// Where one cannot be replaced, what was to go is still there.
TEST(WholeFolder, NothingGoesBeforeAllIsThere) {
  const test::TemporaryFolder parent;
  const fs::path folder = parent / "there";
  fs::create_directories(folder / "a/in_the_way");
  std::ofstream(folder / "old") << "before";
  const auto fill = [](const fs::path& unfinished) { std::ofstream(unfinished / "a") << "new"; };
  EXPECT_THROW(fill_folder(folder, fill, {"old"}), IoError);
  EXPECT_EQ(read_text(folder / "old"), "before");
  EXPECT_TRUE(fs::exists(folder / "a/in_the_way"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2);
}

TEST(WholeFolder, OneThatIsAbsentIsFilledInOneStepAndAFileIsRefused) {
  const test::TemporaryFolder parent;
  fs::create_directory(parent / "any");
  fill_folder(parent / "absent", [&](const fs::path& unfinished) {
    EXPECT_FALSE(fs::exists(parent / "absent"));
    std::ofstream(unfinished / "a") << "new";
  });
  EXPECT_EQ(read_text(parent / "absent/a"), "new");
  EXPECT_EQ(fs::status(parent / "absent").permissions(), fs::status(parent / "any").permissions());
  std::ofstream(parent / "file") << "mine";
  EXPECT_THROW(fill_folder(parent / "file", [](const fs::path&) { FAIL() << "is not asked"; }), IoError);
  EXPECT_EQ(read_text(parent / "file"), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(parent.path()), {}), 3);
}

// What commands ask before their work: a file that stands in the way, or a folder that holds something.
TEST(WholeFolder, OneThatIsTakenIsToldBeforeTheWork) {
  const test::TemporaryFolder parent;
  EXPECT_NO_THROW(refuse_taken(parent / "absent"));
  fs::create_directory(parent / "there");
  EXPECT_NO_THROW(refuse_taken(parent / "there"));
  std::ofstream(parent / "there/mine") << "x";
  EXPECT_EQ(test::message_of<InvalidInput>([&] { refuse_taken(parent / "there"); }),
            (parent / "there").string() + ": exists and is not empty: nothing was written");
  EXPECT_THROW(refuse_taken(parent / "there/mine"), InvalidInput);
  EXPECT_EQ(test::message_of<IoError>([&] { refuse_unwritable(parent / "there/mine", "report.pdf"); }),
            "report.pdf: cannot be written: Not a directory");
}

// A full disk makes empty folders and files: only bytes tell.
TEST(WholeFolder, AFullDiskIsToldBeforeTheWork) {
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(refuse_unwritable(folder.path()));
  std::string message;
  {
    const test::FullDisk full;
    message = test::message_of<IoError>([&] { refuse_unwritable(folder.path(), folder / "achieved.json"); });
  }
  EXPECT_EQ(message, (folder / "achieved.json").string() + ": cannot be written: File too large");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace arthronaut::files
