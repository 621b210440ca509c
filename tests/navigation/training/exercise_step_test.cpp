#include "navigation/training/exercise_step.h"

#include <gtest/gtest.h>

namespace arthronaut::training {
namespace {

using simulator::Held;

std::string step(Goal goal, Held held, const auto& change) {
  operation::OperationState state;
  simulator::HandState hand;
  hand.held = held;
  change(state, hand);
  return exercise_step(goal, state, hand);
}
constexpr auto kNothing = [](operation::OperationState&, simulator::HandState&) {};

// What the operation asks for (to draw, to register) is no part of finding a tip, or of aiming.
TEST(ExerciseStep, OfAPartIsItsOwn) {
  EXPECT_EQ(step(Goal::Pivot, Held::Probe, kNothing), "set the probe's tip on the bone");
  EXPECT_EQ(step(Goal::Pivot, Held::Probe, [](auto&, auto& hand) { hand.touches_bone = true; }),
            "tilt the handle to all sides, then Enter: done");
  EXPECT_EQ(step(Goal::Pivot, Held::Guide, kNothing), "take the probe: G");
  EXPECT_EQ(step(Goal::Aim, Held::Guide, kNothing), "bring the guide into view");
  EXPECT_EQ(step(Goal::Aim, Held::Guide, [](auto& state, auto&) { state.guided_lately = true; }),
            "follow the bullseye; on the plan: Enter, done");
  EXPECT_EQ(step(Goal::Aim, Held::Guide,
                 [](auto& state, auto&) {
                   state.guided_lately = true;
                   state.frame.guidance.state = guidance::GuidanceState::WorldMarkerLost;
                 }),
            "bring the bone's marker into view");
  EXPECT_EQ(step(Goal::Aim, Held::Probe, kNothing), "take the guide: G");
}

// Where the operation itself is practised its own steps lead, until what was to be reached is.
TEST(ExerciseStep, OfAnOperationIsTheOperationsUntilItIsReached) {
  EXPECT_EQ(step(Goal::Register, Held::Probe, kNothing), "");
  EXPECT_EQ(step(Goal::Drill, Held::Guide, kNothing), "");
  EXPECT_EQ(step(Goal::Drill, Held::Guide,
                 [](auto& state, auto&) { state.verification = operation::Verification::ByTouches; }),
            "");
  EXPECT_EQ(step(Goal::Register, Held::Probe,
                 [](auto& state, auto&) { state.verification = operation::Verification::ByTouches; }),
            "verified: Enter, done");
  EXPECT_EQ(
      step(Goal::Drill, Held::Guide,
           [](auto& state, auto&) { state.drilled.outcome = operation::DrilledState::Outcome::Recorded; }),
      "drilled: Enter, done");
}

}  // namespace
}  // namespace arthronaut::training
