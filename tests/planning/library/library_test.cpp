#include "planning/library/library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "planning/cases/case_note.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class LibraryTest : public ::testing::Test {
 protected:
  LibraryTest() : root_(fs::canonical(folder_.path())) {}
  [[nodiscard]] fs::path add_case(const std::string& name) const {
    test::make_case(root_ / (name + ".arthro"), {.name = name});
    return root_ / (name + ".arthro");
  }
  [[nodiscard]] std::unique_ptr<Library> open() {
    return std::make_unique<Library>(root_ / "data", [this](const fs::path&) {
      ++sessions_read_;
      return SessionFacts{};
    });
  }
  static std::vector<std::string> names(const std::vector<CaseRecord>& records) {
    std::vector<std::string> all;
    for (const CaseRecord& record : records)
      all.push_back(record.name + (record.is_there ? "" : " (missing)"));
    std::sort(all.begin(), all.end());
    return all;
  }
  static void add(Library& library, const fs::path& folder) { (void)library.add(std::array{folder}); }

  const test::TemporaryFolder folder_;
  const fs::path root_;
  int sessions_read_ = 0;
};

TEST_F(LibraryTest, KnowsWhatWasAddedAndReadsOnlyWhatHasChanged) {
  const fs::path a = add_case("A"), b = add_case("B");
  fs::create_directories(a / "sessions" / "0001-20260131-120000");
  {
    const auto library = open();
    EXPECT_THAT(library->look(), IsEmpty());
    EXPECT_EQ(library->add(std::array{a, b, a / ".." / "B.arthro"}), 2U) << "one folder has one name";
    EXPECT_THAT(library->known(), IsEmpty()) << "not read yet";
    EXPECT_THAT(names(library->look()), ElementsAre("A", "B"));
    EXPECT_EQ(sessions_read_, 1);
  }
  const auto library = open();
  EXPECT_THAT(names(library->known()), ElementsAre("A", "B"));
  EXPECT_THAT(names(library->look()), ElementsAre("A", "B"));
  EXPECT_EQ(sessions_read_, 1) << "nothing has changed";
  cases::save_note_over(a, "looked at", "");
  const auto records = library->look();
  EXPECT_EQ(sessions_read_, 2);
  EXPECT_TRUE(
      std::any_of(records.begin(), records.end(), [](const auto& r) { return r.note == "looked at"; }));
}

// What cannot be read now may be readable the next time, though no file has changed: by a newer program, or
// when a disk is well again.
TEST_F(LibraryTest, WhatCouldNotBeReadIsReadAgain) {
  const fs::path a = add_case("A");
  fs::create_directories(a / "sessions" / "0001-20260131-120000");
  bool is_well = false;
  Library library(root_ / "data", [&](const fs::path&) {
    ++sessions_read_;
    SessionFacts facts;
    if (!is_well) facts.problem = "the disk does not answer";
    return facts;
  });
  add(library, a);
  EXPECT_EQ(library.look().at(0).sessions.at(0).problem, "the disk does not answer");
  is_well = true;
  EXPECT_EQ(library.look().at(0).sessions.at(0).problem, "");
  (void)library.look();
  EXPECT_EQ(sessions_read_, 2) << "read once it is known again";
}

// What is gone is said to be missing with what was known of it, and is back when its folder is.
TEST_F(LibraryTest, ACaseThatIsGoneStaysAsMissingUntilItIsForgotten) {
  const fs::path a = add_case("A");
  const auto library = open();
  add(*library, a);
  (void)library->look();
  fs::rename(a, root_ / "elsewhere");
  auto records = library->look();
  ASSERT_THAT(names(records), ElementsAre("A (missing)"));
  EXPECT_EQ(records[0].side, bones::Side::Left);
  EXPECT_THAT(names(library->known()), ElementsAre("A (missing)"));
  fs::rename(root_ / "elsewhere", a);
  EXPECT_THAT(names(library->look()), ElementsAre("A"));
  library->forget(a);
  EXPECT_THAT(library->look(), IsEmpty());
  EXPECT_TRUE(fs::exists(a / "case.json")) << "its folder is not touched";
  EXPECT_THROW(library->forget(a), InvalidInput);
}

TEST_F(LibraryTest, KnowsTheCasesOfItsOwnFolderWithoutBeingTold) {
  fs::create_directories(root_ / "data" / "cases");
  test::make_case(root_ / "data" / "cases" / "Imported.arthro", {.name = "Imported"});
  EXPECT_THAT(names(open()->look()), ElementsAre("Imported"));
}

TEST_F(LibraryTest, RefusesWhatIsNoCaseAndPassesItOverInRecentLists) {
  const fs::path a = add_case("A");
  const auto library = open();
  EXPECT_THROW((void)library->add(std::array{a, root_ / "none.arthro"}), InvalidInput);
  EXPECT_THAT(library->look(), IsEmpty());
  library->add_those_there(std::array{root_ / "none.arthro", a});
  EXPECT_THAT(names(library->look()), ElementsAre("A"));
}

// A broken case is one line of the list, and does not keep the others from it.
TEST_F(LibraryTest, ABrokenCaseIsListedWithItsReason) {
  const fs::path a = add_case("A"), b = add_case("B");
  test::write_text(a / "case.json", "{ broken");
  const auto library = open();
  (void)library->add(std::array{a, b});
  const auto records = library->look();
  ASSERT_THAT(records, SizeIs(2));
  for (const CaseRecord& record : records)
    EXPECT_EQ(record.state(), record.folder == a ? CaseState::Unreadable : CaseState::Planned);
}

class DamagedIndex : public LibraryTest, public ::testing::WithParamInterface<const char*> {};

// The index is a cache: whatever happens to it, the list is the same, and the user is told.
TEST_P(DamagedIndex, IsMadeAnewAndThatIsSaid) {
  const std::string damage = GetParam();
  const fs::path index = root_ / "data" / "library-4.sqlite";
  {
    const auto library = open();
    for (const char* name : {"A", "B", "C"}) add(*library, add_case(name));
    cases::save_note_over(root_ / "A.arthro", "kept", "");
    (void)library->look();
  }
  std::string bytes = files::read_text(index);
  if (damage == "gone") fs::remove(index);
  if (damage == "no database")
    test::write_text(index, "this is no database, and longer than its header is\n");
  if (damage == "half of it") test::write_text(index, bytes.substr(0, bytes.size() / 2));
  if (damage == "pages overwritten") {
    std::fill(bytes.begin() + 4096, bytes.end(), '\x7f');
    test::write_text(index, bytes);
  }
  const auto library = open();
  EXPECT_EQ(library->notices().empty(), damage == "gone");
  if (!library->notices().empty()) {
    EXPECT_THAT(library->notices().front(), HasSubstr("made anew"));
    EXPECT_TRUE(fs::exists(root_ / "data" / "library-4.sqlite.damaged"));
  }
  const auto records = library->look();
  EXPECT_THAT(names(records), ElementsAre("A", "B", "C"));
  EXPECT_TRUE(std::any_of(records.begin(), records.end(), [](const auto& r) { return r.note == "kept"; }));
  EXPECT_THAT(open()->notices(), IsEmpty()) << "it is whole now";
}

INSTANTIATE_TEST_SUITE_P(All, DamagedIndex,
                         ::testing::Values("gone", "no database", "half of it", "pages overwritten"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Two that have it open when it is damaged: one makes it anew, the other takes that one's, and what both add
// afterwards is in one list.
TEST_F(LibraryTest, OfTwoThatFindTheIndexDamagedOneMakesItAnew) {
  const fs::path index = root_ / "data" / "library-4.sqlite";
  const auto first = open(), second = open();
  add(*first, add_case("A"));
  EXPECT_THAT(names(second->look()), ElementsAre("A"));
  std::string bytes = files::read_text(index);
  std::fill(bytes.begin(), bytes.end(), '\x7f');
  std::ofstream(index, std::ios::binary | std::ios::in) << bytes;  // the same file, still open
  EXPECT_THAT(names(first->look()), ElementsAre("A"));
  EXPECT_THAT(first->notices(), SizeIs(1));
  EXPECT_THAT(names(second->look()), ElementsAre("A"));
  EXPECT_THAT(second->notices(), IsEmpty()) << "it is whole again";
  add(*first, add_case("B"));
  EXPECT_THAT(names(second->look()), ElementsAre("A", "B"));
  EXPECT_THAT(names(open()->known()), ElementsAre("A", "B"));
}

TEST_F(LibraryTest, RefusesABrokenListOfFoldersAndLeavesIt) {
  fs::create_directories(root_ / "data");
  test::write_text(root_ / "data" / "case_folders.json", "{ broken");
  EXPECT_THROW((void)open(), InvalidInput);
  EXPECT_EQ(files::read_text(root_ / "data" / "case_folders.json"), "{ broken");
}

// Names of folders are bytes; they come back as they were from both files.
TEST_F(LibraryTest, KnowsFoldersByAnyName) {
  const std::vector<std::string> given{"Knie \xC3\x84 100%", "broken \xFF utf", "quote \" and \\ and %41",
                                       "two\nlines"};
  {
    const auto library = open();
    for (const std::string& name : given) {
      test::make_case(root_ / (name + ".arthro"));
      add(*library, root_ / (name + ".arthro"));
    }
    EXPECT_THAT(library->look(), SizeIs(given.size()));
  }
  fs::remove(root_ / "data" / "library-4.sqlite");
  for (const CaseRecord& record : open()->look()) EXPECT_TRUE(record.is_there) << record.folder;
  EXPECT_THAT(open()->known(), SizeIs(given.size()));
}

// Hazard 19: its owner's alone, and without the patient.
TEST_F(LibraryTest, Hazard19IsPrivateAndNamesNobody) {
  const fs::path a = add_case("A");
  cases::save_identity(a, {"Muster^Anna", "4711", "19900131"});
  const auto library = open();
  add(*library, a);
  (void)library->look();
  for (const char* file : {"library-4.sqlite", "case_folders.json", "library.lock"}) {
    EXPECT_EQ(fs::status(root_ / "data" / file).permissions(), fs::perms::owner_read | fs::perms::owner_write)
        << file;
    EXPECT_THAT(files::read_text(root_ / "data" / file), ::testing::Not(HasSubstr("Muster"))) << file;
  }
}

// Four programs add forty cases each at the same time, each looking meanwhile: nobody's are lost.
TEST_F(LibraryTest, ManyProgramsAtOnceLoseNothing) {
  constexpr int kPrograms = 4, kCases = 40;
  for (int i = 0; i < kPrograms * kCases; ++i) (void)add_case("Knee" + std::to_string(i));
  std::vector<pid_t> programs;
  for (int program = 0; program < kPrograms; ++program) {
    const pid_t child = ::fork();
    if (child == 0) {
      int exit_code = 0;
      try {
        const auto library = open();
        for (int i = 0; i < kCases; ++i) {
          add(*library, root_ / ("Knee" + std::to_string(program * kCases + i) + ".arthro"));
          if (i % 10 == 0) (void)library->look();
        }
      } catch (const std::exception&) {
        exit_code = 1;
      }
      ::_exit(exit_code);
    }
    programs.push_back(child);
  }
  for (const pid_t program : programs) {
    int status = -1;
    ::waitpid(program, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_THAT(open()->look(), SizeIs(kPrograms * kCases));
  fs::remove(root_ / "data" / "library-4.sqlite");
  EXPECT_THAT(open()->look(), SizeIs(kPrograms * kCases)) << "and the list of folders has them all";
}

// Stopped in the middle: what was read is kept, the rest is read the next time.
TEST_F(LibraryTest, ALookCanBeStopped) {
  const auto library = open();
  for (const char* name : {"A", "B", "C"}) add(*library, add_case(name));
  int asked = 0;
  EXPECT_THAT(library->look([&](std::size_t, std::size_t) { return ++asked < 2; }), SizeIs(1));
  EXPECT_THAT(names(library->look()), ElementsAre("A", "B", "C"));
}

}  // namespace
}  // namespace arthronaut::library
