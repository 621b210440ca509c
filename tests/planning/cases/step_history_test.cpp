#include "planning/cases/step_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using ::testing::HasSubstr;

PlanState state_at(double x_mm) {
  PlanState state;
  state.plan.put({.entry_mm = {x_mm, 0.1, -1.0 / 3},
                  .direction = Eigen::Vector3d(-0.83, -0.32, 0.41).normalized(),
                  .diameter_mm = 8.7},
                 "abc");
  state.landmarks[BoneKind::Femur] = {{"a", {1.0 / 7, 2, 3}}};
  state.landmark_states[BoneKind::Femur] = {{"a", landmarks::LandmarkState::Proposed}};
  return state;
}

StepHistory history_of(int count) {
  StepHistory history;
  for (int i = 0; i < count; ++i)
    history.steps.push_back({"step " + std::to_string(i), state_at(i), state_at(i + 1)});
  history.position = history.steps.size();
  return history;
}

// What comes back is what was written, to the bit: a step back leads to where it was, not near it.
TEST(StepHistory, ComesBackToTheBit) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(load_step_history(folder.path()).steps.empty());
  StepHistory history = history_of(3);
  PlanState other = state_at(2);
  other.measurements = {{{{1, 2, 3}, {4, 5, 6}}}};
  other.landmarks[BoneKind::Tibia] = {{"b", {0.1, 0.2, 0.3}}};
  other.landmark_states[BoneKind::Tibia] = {{"b", landmarks::LandmarkState::Confirmed}};
  history.steps.push_back({"measure", state_at(3), other});
  history.position = 2;
  save_step_history(folder.path(), history);
  const StepHistory back = load_step_history(folder.path());
  EXPECT_EQ(back.position, 2U);
  ASSERT_EQ(back.steps.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(back.steps[i].what, history.steps[i].what);
    EXPECT_TRUE(back.steps[i].before == history.steps[i].before) << i;
    EXPECT_TRUE(back.steps[i].after == history.steps[i].after) << i;
  }
  EXPECT_FALSE(back.steps[0].before == back.steps[0].after);
  save_step_history(folder.path(), {});
  EXPECT_TRUE(folder.names().empty());
}

// The state of the case tells how many steps are done: the one that was noted, or where a crash came between
// the steps and the plan, the nearest; none where it is none of them.
TEST(StepHistory, FindsWhereTheCaseIs) {
  StepHistory history = history_of(4);
  EXPECT_EQ(history.position_of(state_at(4)), 4U);
  EXPECT_EQ(history.position_of(state_at(3)), 3U) << "the plan was not saved any more";
  EXPECT_EQ(history.position_of(state_at(0)), 0U);
  EXPECT_FALSE(history.position_of(state_at(9)));
  PlanState confirmed = state_at(3);
  confirmed.landmark_states[BoneKind::Femur]["a"] = landmarks::LandmarkState::Confirmed;
  EXPECT_FALSE(history.position_of(confirmed));
  // Back to where it began and there again: of two places the nearer one.
  history.steps.push_back({"back", state_at(4), state_at(1)});
  history.position = 4;
  EXPECT_EQ(history.position_of(state_at(1)), 5U);
  EXPECT_FALSE(StepHistory{}.position_of(state_at(0)));
}

// An evening's work is small beside a bone's mesh: what the steps share stands there once.
TEST(StepHistory, OfManyStepsIsSmall) {
  const test::TemporaryFolder folder;
  save_step_history(folder.path(), history_of(static_cast<int>(kMostSteps)));
  EXPECT_LT(std::filesystem::file_size(step_history_file(folder.path())), 250'000U);
  EXPECT_EQ(load_step_history(folder.path()).steps.size(), kMostSteps);
}

TEST(StepHistory, AFileThatIsNoneIsRefusedByPlace) {
  const test::TemporaryFolder folder;
  save_step_history(folder.path(), history_of(1));
  std::string text = files::read_text(step_history_file(folder.path()));
  const auto at = text.rfind("\"after\": 1");
  ASSERT_NE(at, std::string::npos);
  files::write_atomically(step_history_file(folder.path()), text.replace(at, 10, "\"after\": 7"));
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_step_history(folder.path()); }),
              HasSubstr("history.json: steps[0].after: names nothing"));
}

}  // namespace
}  // namespace arthronaut::cases
