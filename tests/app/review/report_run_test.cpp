#include "app/review/report_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <thread>
#include <utility>

#include "planning/cases/plan_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ReportRunTest : public ::testing::Test {
 protected:
  // Stands for the program: what it is given stands in the file "given".
  fs::path program(const std::string& does) const {
    const fs::path file = folder_ / "program";
    std::ofstream(file) << "#!/bin/sh\necho \"$@\" > '" << (folder_ / "given").string() << "'\n"
                        << does << "\n";
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }
  // Of the run once it has ended.
  std::string problem_of(const fs::path& program, const std::string& session = "0001") const {
    std::promise<void> woken;
    ReportRun run(
        folder_.path(), plan_, session,
        [&, once = false]() mutable {
          if (!std::exchange(once, true)) woken.set_value();
        },
        program);
    woken.get_future().wait();
    while (!run.has_ended()) std::this_thread::yield();
    return run.problem();
  }
  fs::path of_plan() const { return cases::export_folder(folder_.path(), plan_); }
  const test::TemporaryFolder folder_;
  cases::Plan plan_{.tunnels = {{bones::BoneKind::Femur, {}}}};
};

TEST_F(ReportRunTest, AsksForTheSessionThatIsShown) {
  EXPECT_EQ(problem_of(program("exit 0")), "");
  std::ifstream given(folder_ / "given");
  std::string words;
  std::getline(given, words);
  EXPECT_EQ(words, "report " + folder_.path().string() + " --session 0001 -o " +
                       (of_plan() / "report_0001.pdf").string() + " --progress-fd 3");
  EXPECT_FALSE(fs::exists(of_plan() / "report_0001.pdf.log"));
}

// A CT after the operation is to be reported on, whether the operation was recorded or not.
TEST_F(ReportRunTest, AsksForTheCaseWhereThereIsNoSession) {
  EXPECT_EQ(problem_of(program("exit 0"), ""), "");
  std::ifstream given(folder_ / "given");
  std::string words;
  std::getline(given, words);
  EXPECT_EQ(words, "report " + folder_.path().string() + " -o " + (of_plan() / "report.pdf").string() +
                       " --progress-fd 3");
}

// What was written before may have been read by somebody: it stays, and the next one has a number.
TEST_F(ReportRunTest, AReportThatIsThereStays) {
  for (const char* expected : {"report.pdf", "report_2.pdf", "report_3.pdf"}) {
    EXPECT_EQ(problem_of(program("while [ \"$1\" != -o ]; do shift; done; echo new > \"$2\""), ""), "");
    EXPECT_TRUE(fs::exists(of_plan() / expected)) << expected;
  }
}

// Stopped in the moment in which it had ended: the report is there, and is not said to be missing.
TEST_F(ReportRunTest, OneThatHadEndedWhenItWasStoppedIsThere) {
  bool is_first = true;
  const auto stops = [&] {  // asked after the process was looked at for the first time: it ends meanwhile
    if (is_first) std::this_thread::sleep_for(std::chrono::milliseconds(500));
    is_first = false;
    return true;
  };
  const auto outcome =
      own_process::run_command(program("sleep 0.1; exit 4"), {"report"}, folder_ / "log", stops);
  EXPECT_EQ(outcome.end, own_process::CommandOutcome::End::Unreliable);
  const auto stopped =
      own_process::run_command(program("exec sleep 60"), {"report"}, folder_ / "log", [] { return true; });
  EXPECT_EQ(stopped.end, own_process::CommandOutcome::End::Stopped);
}

// Two plans never share a folder, and whoever holds a report knows which plan it tells of. It lay beside
// tables of another plan.
TEST_F(ReportRunTest, LiesInThePlansOwnFolder) {
  const fs::path before = of_plan();
  plan_.tunnels.at(bones::BoneKind::Femur).diameter_mm += 1;
  EXPECT_NE(of_plan(), before);
  EXPECT_EQ(of_plan().parent_path(), folder_ / "export");
  EXPECT_EQ(of_plan().filename().string(), "plan_" + cases::plan_sha256(plan_).substr(0, 12));
  plan_ = {};
  EXPECT_EQ(of_plan(), folder_ / "export") << "where nothing is planned";
}

TEST_F(ReportRunTest, SaysWhyThereIsNone) {
  EXPECT_EQ(problem_of(program("echo 'arthronaut: plan.json: is broken' >&2; exit 2")),
            "plan.json: is broken");
  EXPECT_EQ(problem_of(program("kill -9 $$")), "the report could not be written");
  EXPECT_THAT(problem_of(folder_ / "none"), HasSubstr("cannot be started"));
}

// It took twenty seconds of which nothing was told, and could not be stopped.
TEST_F(ReportRunTest, TellsWhatGoesOnAndStops) {
  ReportRun run(
      folder_.path(), plan_, "0001", [] {},
      program("echo '0.250 Reading' >&3; printf '0.500 Drawing the plan\\n0.7' >&3; exec sleep 600"));
  const auto wait_until = [](const auto& is_so) {
    for (int i = 0; i < 3000 && !is_so(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return is_so();
  };
  EXPECT_TRUE(wait_until([&] { return run.progress().what == "Drawing the plan"; }));
  EXPECT_EQ(run.progress().share, 0.5);
  EXPECT_FALSE(run.has_ended());
  run.stop();
  EXPECT_TRUE(wait_until([&] { return run.has_ended(); }));
  EXPECT_TRUE(run.was_stopped());
}

// Letting go of it ends the process: nobody waits for it.
TEST_F(ReportRunTest, EndsWithWhoAskedForIt) {
  {
    const ReportRun run(
        folder_.path(), plan_, "0001", [] {}, program("exec sleep 600"));
  }
  EXPECT_FALSE(fs::exists(of_plan() / "report_0001.pdf.log"));
}

}  // namespace
}  // namespace arthronaut::review
