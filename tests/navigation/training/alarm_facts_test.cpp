// What becomes of an alarm, by the states of a real operation.
#include <gtest/gtest.h>

#include "navigation/training/exercise_facts.h"
#include "navigation/training/exercise_run.h"
#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::training {
namespace {

using registration::phantom_bone;

// The marker is hit, the control point tells it: what the trainee then says of it.
ExerciseFacts facts_after(const operation::Command& answer) {
  const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  test::PhantomOperation run;
  const operation::SourceSetup source = test::scripted_source();
  run.start(source);
  run.apply(test::true_registration(trial, provenance_of(run.operation().setup(), source)));
  Examiner examiner(*find_exercise("drill-femur"), test::phantom_plan().tunnel, 30, {0, 0, 0});
  simulator::HandTruth truth;
  truth.faults = 1U << static_cast<unsigned>(simulator::FaultKind::BumpedMarker);
  run.on_frame = [&](const operation::OperationState& state) {
    truth.time_s += 1.0 / 60;
    examiner.add(state, truth);
  };
  const Eigen::Vector3d control = test::on_bone(trial, 6), bump(0, 0, 2.4);
  run.touch(control, operation::TouchControlPoint{});
  run.touch(control + bump, operation::TouchControlPoint{});
  run.touch(control + bump, operation::TouchControlPoint{});
  run.show(run.frame());
  EXPECT_EQ(examiner.facts().alarms, 1);
  EXPECT_EQ(examiner.facts().alarms_ignored, 0);
  run.apply(answer);
  run.show(run.frame());
  run.on_frame = {};
  return examiner.facts();
}

TEST(AlarmFacts, OneThatIsWavedAwayIsIgnored) {
  EXPECT_EQ(facts_after(operation::ForgetTouches{}).alarms_ignored, 1);
}

TEST(AlarmFacts, OneThatEndsWithTheMarkerPlacedAnewIsHeeded) {
  EXPECT_EQ(facts_after(operation::MarkerPlacedAnew{}).alarms_ignored, 0);
}

// Hazard 40: should what an exercise takes for known ever reach a live source, the operation itself lets it
// guide nothing, and no touch confirms it.
TEST(KnownRegistration, Hazard40IsVoidForALiveSourceForGood) {
  const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  test::PhantomOperation run;
  run.start(test::scripted_source(sources::SourceKind::Live));
  simulator::HandTruth truth;
  truth.marker_from_bone = trial.marker_from_bone;
  run.apply(operation::GiveRegistration{
      known_registration(truth),
      provenance_of(run.operation().setup(), test::scripted_source(sources::SourceKind::Simulation)), false});
  run.apply(operation::SkipVerification{});
  EXPECT_EQ(run.in_force().standing, operation::Standing::Void);
  run.touch(test::on_bone(trial, 6));
  EXPECT_EQ(run.in_force().standing, operation::Standing::Void);
  EXPECT_FALSE(run.in_force().can_be_confirmed);
}

}  // namespace
}  // namespace arthronaut::training
