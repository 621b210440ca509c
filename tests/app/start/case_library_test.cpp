#include "app/start/case_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/library/workstation_library.h"
#include "planning/cases/case_note.h"
#include "planning/cases/identity.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class CaseLibraryTest : public ::testing::Test {
 protected:
  CaseLibraryTest() : folder_(), case_(std::filesystem::canonical(folder_.path()) / "A.arthro") {
    test::make_case(case_, {.name = "A"});
  }
  static void wait(CaseLibrary& library) {
    while (!library.poll()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  [[nodiscard]] std::filesystem::path data() const { return folder_ / "data"; }

  const test::TemporaryFolder folder_;
  const std::filesystem::path case_;
};

// A recent case is known from then on; the next start shows it before any folder is looked at.
TEST_F(CaseLibraryTest, ShowsWhatIsKnownAtOnceAndLooksBeside) {
  int woken = 0;
  {
    CaseLibrary library(data(), [&] { ++woken; });
    library.refresh({case_, folder_ / "gone.arthro"});
    EXPECT_TRUE(library.is_looking());
    EXPECT_THAT(library.records(), IsEmpty());
    wait(library);
    EXPECT_EQ(woken, 1);
    EXPECT_THAT(library.records(), SizeIs(1));
  }
  CaseLibrary library(data(), [] {});
  library.refresh({});
  ASSERT_THAT(library.records(), SizeIs(1));
  EXPECT_EQ(library.records()[0].name, "A");
  wait(library);
  EXPECT_THAT(library.records(), SizeIs(1));
  EXPECT_EQ(library.what(), "");
}

// The look reads them, not who seeks; and the next start knows none before its own look.
TEST_F(CaseLibraryTest, KnowsWhoseTheyAreOnceItHasLooked) {
  cases::save_identity(case_, {"Muster^Anna", "4711", "19900131"});
  for (int start = 0; start < 2; ++start) {
    CaseLibrary library(data(), [] {});
    library.refresh({case_});
    EXPECT_THAT(library.identities(), IsEmpty());
    wait(library);
    ASSERT_TRUE(library.identities().contains(case_));
    EXPECT_EQ(library.identities().at(case_).patient_id, "4711");
  }
}

TEST_F(CaseLibraryTest, NotesAndForgetsAndSaysWhatFails) {
  CaseLibrary library(data(), [] {});
  library.refresh({case_});
  wait(library);
  EXPECT_TRUE(library.save_note(case_, "mine", ""));
  EXPECT_EQ(library.records()[0].note, "mine");
  cases::save_note_over(case_, "theirs", "mine");
  EXPECT_FALSE(library.save_note(case_, "mine again", "mine"));
  EXPECT_THAT(library.what(), HasSubstr("changed meanwhile"));
  EXPECT_EQ(cases::load_note(case_).text, "theirs");
  EXPECT_TRUE(library.forget(case_));
  EXPECT_THAT(library.records(), IsEmpty());
  EXPECT_FALSE(library.forget(case_));
  EXPECT_THAT(library.what(), HasSubstr("not in the list"));
}

// A note that is kept while the folders are looked at is not taken back by what the look had read before.
TEST_F(CaseLibraryTest, ANoteThatIsKeptDuringALookStays) {
  CaseLibrary library(data(), [] {});
  library.refresh({case_});
  wait(library);
  for (int i = 0; i < 20; ++i) {
    const std::string before = library.records().at(0).note, note = "note " + std::to_string(i);
    library.refresh({});
    std::this_thread::sleep_for(std::chrono::microseconds(200 * i));
    ASSERT_TRUE(library.save_note(case_, note, before));
    wait(library);
    ASSERT_EQ(library.records().at(0).note, note) << i;
  }
}

// What is wrong with the list is said, and stays said when the look has ended well.
TEST_F(CaseLibraryTest, SaysThatTheListWasDamagedOrCannotBeHad) {
  workstation_library::note_case(case_, data());
  test::write_text(data() / "library-4.sqlite",
                   "this is no database, and longer than a header of one would be");
  CaseLibrary damaged(data(), [] {});
  damaged.refresh({});
  wait(damaged);
  EXPECT_THAT(damaged.what(), HasSubstr("made anew"));
  EXPECT_THAT(damaged.records(), SizeIs(1));
  CaseLibrary nowhere("/proc/nowhere", [] {});
  nowhere.refresh({});
  wait(nowhere);
  EXPECT_THAT(nowhere.what(), HasSubstr("/proc/nowhere"));
}

}  // namespace
}  // namespace arthronaut::start
