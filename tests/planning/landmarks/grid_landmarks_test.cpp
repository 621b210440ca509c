// How well a grid is looked after, as a state: no reader has to take it from the words.
#include "planning/landmarks/grid_landmarks.h"

#include <gtest/gtest.h>

namespace arthronaut::landmarks {
namespace {

using bones::BoneKind;

struct Known {
  Landmarks at_mm;
  LandmarkStates states;
};
Known all_confirmed(BoneKind bone) {
  Known known;
  for (const std::string& name : grid_landmarks(bone, {})) {
    known.at_mm[name] = Eigen::Vector3d::Zero();
    known.states[name] = LandmarkState::Confirmed;
  }
  return known;
}

class GridOf : public ::testing::TestWithParam<BoneKind> {};

// One landmark that nobody looked at makes the whole grid proposed, whatever else is missing; one that is
// missing alone leaves it incomplete. What is said begins with what it is.
TEST_P(GridOf, IsInTheStateOfItsLeastLandmark) {
  const BoneKind bone = GetParam();
  const std::vector<std::string> names = grid_landmarks(bone, {});
  const auto state_of_grid = [&](const Known& known) { return grid_state(bone, known.at_mm, known.states); };
  const Known confirmed = all_confirmed(bone);
  EXPECT_EQ(state_of_grid(confirmed), GridState::Confirmed);
  EXPECT_EQ(grid_doubt(bone, confirmed.at_mm, confirmed.states), "");
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    Known one_proposed = confirmed, one_missing = confirmed;
    one_proposed.states[name] = LandmarkState::Proposed;
    one_missing.at_mm.erase(name);
    EXPECT_EQ(state_of_grid(one_proposed), GridState::Proposed);
    EXPECT_EQ(state_of_grid(one_missing), GridState::Incomplete);
    EXPECT_TRUE(grid_doubt(bone, one_missing.at_mm, one_missing.states).starts_with("landmarks missing"));
    Known both = one_proposed;
    both.at_mm.erase(name == names.front() ? names.back() : names.front());
    EXPECT_EQ(state_of_grid(both), GridState::Proposed);
    EXPECT_FALSE(is_grid_confirmed(bone, both.at_mm, both.states));
  }
}

INSTANTIATE_TEST_SUITE_P(Both, GridOf, ::testing::Values(BoneKind::Femur, BoneKind::Tibia),
                         [](const auto& test) { return std::string(bones::to_text(test.param)); });

}  // namespace
}  // namespace arthronaut::landmarks
