#include "app/plan/export_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "planning/cases/plan_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan {
namespace {

using testing::StartsWith;

// What came of it: waits as the window does, for the wake.
ExportOutcome outcome_of(const cases::Case& knee, const std::filesystem::path& case_folder) {
  std::promise<void> woken;
  ExportWork work([&] { woken.set_value(); });
  work.start(knee, 7, case_folder);
  EXPECT_TRUE(work.is_running());
  woken.get_future().wait();
  std::optional<ExportOutcome> outcome;
  while (!outcome) outcome = work.take_outcome();
  EXPECT_FALSE(work.is_running());
  EXPECT_FALSE(work.take_outcome()) << "said once";
  return *outcome;
}

TEST(ExportWork, WritesThePlanAndSaysWhere) {
  const test::TemporaryFolder folder;
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "export");
  const std::filesystem::path of_plan =
      cases::export_folder(folder / "Knee.arthro", cases::with_named_meshes(knee));
  const ExportOutcome outcome = outcome_of(knee, folder / "Knee.arthro");
  EXPECT_TRUE(outcome.is_written);
  EXPECT_THAT(outcome.in_words(7), StartsWith("Exported into " + of_plan.string() +
                                              ": plan.json plan.csv plan.mrk.json femur_drilled.stl "
                                              "femur_drilled.ply tibia_drilled.stl tibia_drilled.ply"));
  EXPECT_TRUE(std::filesystem::exists(of_plan / "plan.mrk.json"));
}

// Nothing of it is there afterwards, and the next one is written.
TEST(ExportWork, IsStoppedWithoutATrace) {
  const test::TemporaryFolder folder;
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "export");
  std::atomic<int> woken = 0;
  ExportWork work([&] { ++woken; });
  work.start(knee, 7, folder / "Knee.arthro");
  EXPECT_FALSE(work.is_stopping());
  work.stop();
  EXPECT_TRUE(work.is_stopping()) << "what is shown meanwhile is that it ends, not that it goes on";
  std::optional<ExportOutcome> outcome;
  while (!outcome) outcome = work.take_outcome();
  EXPECT_FALSE(work.is_stopping());
  EXPECT_TRUE(outcome->was_stopped);
  EXPECT_FALSE(outcome->is_written);
  EXPECT_EQ(outcome->in_words(7), "The export was stopped: nothing was written.");
  EXPECT_FALSE(std::filesystem::exists(folder / "Knee.arthro/export"));
  EXPECT_TRUE(outcome_of(knee, folder / "Knee.arthro").is_written);
}

TEST(ExportWork, SaysWhyNothingWasWritten) {
  const test::TemporaryFolder folder;
  const ExportOutcome outcome = outcome_of({}, folder / "Knee.arthro");
  EXPECT_FALSE(outcome.is_written);
  EXPECT_THAT(outcome.in_words(8), StartsWith("Not exported: plan: nothing is planned"));
}

// What cannot be drilled goes out with its warning, not as if nothing were wrong.
TEST(ExportWork, SaysWhatIsWrongWithWhatWasWritten) {
  const ExportOutcome outcome{.is_written = true,
                              .text = "Exported into /cases/A.arthro/export: plan.json",
                              .wrong = {"femur: Wall: -3.5 mm"}};
  EXPECT_EQ(outcome.in_words(0),
            "Exported into /cases/A.arthro/export: plan.json\n"
            "Wrong, and exported all the same: femur: Wall: -3.5 mm");
}

// It takes a while: by then the plan may have been changed, and what lies there is not what is seen.
TEST(ExportWork, SaysThatThePlanWasChangedMeanwhile) {
  const ExportOutcome outcome{.revision = 7,
                              .is_written = true,
                              .text = "Exported into /cases/A.arthro/export: plan.json",
                              .doubts = {"the femur is not closed"}};
  EXPECT_EQ(outcome.in_words(8),
            "Exported into /cases/A.arthro/export: plan.json\n"
            "It is the plan as it was before the last change.\n"
            "Look: the femur is not closed");
  EXPECT_EQ(outcome.in_words(7),
            "Exported into /cases/A.arthro/export: plan.json\nLook: the femur is not closed");
}

}  // namespace
}  // namespace arthronaut::plan
