#include "app/plan/export_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan {
namespace {

using testing::HasSubstr;

// What came of it: waits as the window does, for the wake.
std::string outcome_of(const cases::Case& knee, const std::filesystem::path& folder) {
  std::promise<void> woken;
  ExportWork work([&] { woken.set_value(); });
  work.start(knee, folder);
  EXPECT_TRUE(work.is_running());
  woken.get_future().wait();
  std::optional<std::string> outcome;
  while (!outcome) outcome = work.take_outcome();
  EXPECT_FALSE(work.is_running());
  EXPECT_FALSE(work.take_outcome()) << "said once";
  return *outcome;
}

TEST(ExportWork, WritesThePlanAndSaysWhere) {
  const test::TemporaryFolder folder;
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "export");
  const std::string outcome = outcome_of(knee, folder / "out");
  EXPECT_THAT(outcome,
              HasSubstr("out: plan.json plan.csv plan.mrk.json femur_drilled.stl tibia_drilled.stl"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "plan.mrk.json"));
}

TEST(ExportWork, SaysWhyNothingWasWritten) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(outcome_of({}, folder / "out"), HasSubstr("Not exported: plan: nothing is planned"));
}

}  // namespace
}  // namespace arthronaut::plan
