// `arthronaut cases`: the library as a script sees it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CasesCommand : public ::testing::Test {
 protected:
  CasesCommand() {
    fs::create_directories(folder_ / "knees" / "deep");
    test::make_case(a_, {.name = "Alpha", .side = "left"});
    test::make_case(b_, {.name = "Beta", .side = "right", .is_planned = false});
  }
  [[nodiscard]] test::ProgramResult cases(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "cases");
    return test::run_program(arguments, {.data_home = folder_ / "home"});
  }
  void know_both() const {
    const auto result = cases({"--add", folder_ / "knees"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    ASSERT_THAT(result.output, HasSubstr("2 cases found, 2 of them new"));
  }
  const test::TemporaryFolder folder_;
  const fs::path a_ = folder_ / "knees" / "A.arthro", b_ = folder_ / "knees" / "deep" / "B.arthro";
};

// Whoever lists cases reads of their plans what the window's list shows.
TEST_F(CasesCommand, SaysWhatSpeaksAgainstAPlan) {
  const fs::path knee = folder_ / "Knee.arthro";
  cases::save_case(knee, phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Gamma"));
  cases::save_bone_doubts(knee, {{bones::BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left}}}});
  EXPECT_THAT(cases({"--add", knee}).output, HasSubstr("femur and tibia planned; not checked yet"));
  EXPECT_THAT(cases({"--add", knee, "--check"}).output,
              HasSubstr("femur and tibia planned; wrong: Side: the fibula lies on the left"));
  const auto listed = nlohmann::json::parse(cases({"--json"}).output).at("cases").at(0);
  EXPECT_EQ(listed.at("plan_verdict").at("worst"), "wrong") << "and is not made again";
  EXPECT_THAT(listed.at("plan_verdict").at("wrong").dump(), HasSubstr("check the side"));
}

TEST_F(CasesCommand, FindsListsAndFilters) {
  EXPECT_THAT(cases({}).output, HasSubstr("No case"));
  know_both();
  EXPECT_THAT(cases({}).output,
              AllOf(HasSubstr("Alpha, left knee: planned"), HasSubstr("Beta, right knee: not")));
  EXPECT_THAT(cases({"--side", "left"}).output, Not(HasSubstr("Beta")));
  EXPECT_THAT(cases({"--state", "not planned"}).output, Not(HasSubstr("Alpha")));
  EXPECT_THAT(cases({"--search", "right 2026-01"}).output, AllOf(HasSubstr("Beta"), Not(HasSubstr("Alpha"))));
  EXPECT_THAT(cases({"--search", "spring"}).output, HasSubstr("None of the 2 known cases is like that."));
}

// Adding a folder lists what was found there; another program reads the whole list.
TEST_F(CasesCommand, ListsWhatWasAdded) {
  EXPECT_THAT(cases({"--add", a_}).output, HasSubstr("Alpha, left knee"));
  EXPECT_THAT(cases({"--add", folder_ / "knees" / "deep"}).output,
              AllOf(HasSubstr("1 case found, 1 of them new"), HasSubstr("Beta"), Not(HasSubstr("Alpha"))));
  EXPECT_EQ(nlohmann::json::parse(cases({"--add", b_, "--json"}).output).at("cases").size(), 2U);
}

// A note may be written just now where the case is open.
TEST_F(CasesCommand, Hazard15NotesNothingWithACaseThatAnotherProgramHolds) {
  {
    const cases::CaseLock lock(a_);
    ASSERT_TRUE(lock.is_held()) << lock.refusal();
    const auto result = cases({"--note", a_, "--text", "from the ward"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.errors, HasSubstr("process " + std::to_string(::getpid())));
  }
  EXPECT_EQ(cases({"--note", a_, "--text", "from the ward"}).exit_code, 0);
}

// Another side than the import said: the plan is the other side's, and comes back with it; nothing happens
// where another program has the case.
TEST_F(CasesCommand, SetsTheSideOfACase) {
  const fs::path made = folder_ / "Made.arthro";
  ASSERT_EQ(test::run_program({"phantom", "-o", made, "--quiet"}, {.data_home = folder_ / "home"}).exit_code,
            0);
  {
    const cases::CaseLock lock(made);
    ASSERT_TRUE(lock.is_held()) << lock.refusal();
    EXPECT_EQ(cases({"--set-side", made, "--to", "left"}).exit_code, 3);
  }
  const auto set = cases({"--set-side", made, "--to", "left"});
  EXPECT_EQ(set.exit_code, 0) << set.errors;
  EXPECT_THAT(set.output, AllOf(HasSubstr("it is a left knee now; it was a right one"),
                                HasSubstr("the plan of the right knee is put aside")));
  EXPECT_THAT(cases({}).output, HasSubstr("Made, left knee: not planned"));
  EXPECT_EQ(cases({"--set-side", made, "--to", "right"}).exit_code, 0);
  EXPECT_THAT(cases({}).output, HasSubstr("Made, right knee: planned"));
  EXPECT_EQ(cases({"--set-side", made}).exit_code, 2);
  EXPECT_EQ(cases({"--set-side", made, "--to", "both"}).exit_code, 2);
}

// A case that was copied from a machine on which it was open is this machine's where somebody says so.
TEST_F(CasesCommand, TakesACaseOverFromAnotherMachine) {
  files::write_atomically(
      cases::lock_file(a_),
      R"({"format": "arthronaut.lock", "version": 1, "host": "theatre-2", "process": 4711, "user": "anna",
          "since_utc": "2026-01-31T12:00:00Z"})");
  const auto refused = cases({"--note", a_, "--text", "x"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.errors, HasSubstr("arthronaut cases --take-over '" + a_.string() + "'"));
  const auto taken = cases({"--take-over", a_});
  EXPECT_EQ(taken.exit_code, 0) << taken.errors;
  EXPECT_THAT(taken.output, HasSubstr("Taken over from anna on theatre-2 (process 4711)"));
  EXPECT_EQ(cases({"--note", a_, "--text", "x"}).exit_code, 0);
  const cases::CaseLock lock(a_);
  EXPECT_EQ(cases({"--take-over", a_}).exit_code, 3);
}

TEST_F(CasesCommand, KeepsNotesInTheCase) {
  know_both();
  EXPECT_EQ(cases({"--note", a_, "--text", "look again\n#study"}).exit_code, 0);
  EXPECT_THAT(files::read_text(a_ / "note.json"), HasSubstr("#study"));
  EXPECT_THAT(cases({"--search", "#study"}).output, AllOf(HasSubstr("Alpha"), HasSubstr("\"look again\n")));
  EXPECT_EQ(cases({"--note", a_, "--text", ""}).exit_code, 0);
  EXPECT_FALSE(fs::exists(a_ / "note.json"));
}

// Standard output is the document alone, also when the list has to be made anew.
TEST_F(CasesCommand, WritesJsonAndCsvAndSaysDamageBeside) {
  know_both();
  cases::save_identity(a_, {"Muster^Anna", "4711", "19900131"});
  test::write_file(folder_ / "home" / "arthronaut" / "library-4.sqlite",
                   "this is no database at all, is it\n");
  const auto json = cases({"--json", "--sort", "name"});
  ASSERT_EQ(json.exit_code, 0) << json.errors;
  EXPECT_THAT(json.errors, HasSubstr("made anew"));
  EXPECT_TRUE(nlohmann::json::accept(cases({"--add", a_, "--json"}).output));
  EXPECT_TRUE(nlohmann::json::accept(cases({"--note", a_, "--text", "seen", "--json"}).output));
  const auto document = nlohmann::json::parse(json.output);
  EXPECT_EQ(document.at("format"), "arthronaut.cases");
  ASSERT_EQ(document.at("cases").size(), 2U);
  EXPECT_EQ(document.at("cases").at(0).at("name"), "Alpha");
  EXPECT_THAT(json.output, Not(HasSubstr("Muster")));
  const auto csv = cases({"--csv", "--sort", "name"});
  EXPECT_EQ(csv.errors, "");
  EXPECT_THAT(csv.output, ::testing::StartsWith("case,folder,side,state,"));
  EXPECT_THAT(csv.output, AllOf(HasSubstr("\nAlpha,"), HasSubstr("\nBeta,"), Not(HasSubstr("4711"))));
  EXPECT_THAT(cases({"--csv", "--with-identity"}).output, HasSubstr("Muster^Anna,4711,19900131"));
}

TEST_F(CasesCommand, MissingAndForgottenCases) {
  know_both();
  fs::rename(a_, folder_ / "knees" / "moved");
  EXPECT_THAT(cases({}).output, AllOf(HasSubstr("A"), HasSubstr("missing"), HasSubstr("is not there now")));
  EXPECT_EQ(cases({"--forget", a_}).exit_code, 0);
  EXPECT_THAT(cases({}).output, Not(HasSubstr("missing")));
}

// A case that a command makes is known without being added.
TEST_F(CasesCommand, KnowsTheCasesThatCommandsMake) {
  const fs::path made = folder_ / "Made.arthro";
  ASSERT_EQ(test::run_program({"phantom", "-o", made, "--quiet"}, {.data_home = folder_ / "home"}).exit_code,
            0);
  EXPECT_THAT(cases({}).output, HasSubstr("Made, right knee: planned"));
}

TEST_F(CasesCommand, RefusesWithTheReason) {
  const auto expect_refused = [&](const std::vector<std::string>& arguments, int exit_code,
                                  const std::string& reason) {
    const auto result = cases(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(reason));
    EXPECT_EQ(result.output, "");
  };
  fs::create_directories(folder_ / "empty");
  expect_refused({"--add", folder_ / "none"}, 3, "none: ");
  expect_refused({"--add", folder_ / "empty"}, 3, "empty: holds no case");
  expect_refused({"--forget", a_}, 3, "is not in the list");
  expect_refused({"--note", folder_ / "empty", "--text", "x"}, 3, "is not a case");
  expect_refused({"--note", a_}, 2, "--text");
  expect_refused({"--state", "lost"}, 2, "lost");
  expect_refused({"--json", "--csv"}, 2, "--csv");
  test::write_file(folder_ / "home" / "arthronaut" / "case_folders.json", "{ broken");
  fs::remove(folder_ / "home" / "arthronaut" / "library-4.sqlite");
  expect_refused({}, 3, "case_folders.json");
}

}  // namespace
}  // namespace arthronaut
