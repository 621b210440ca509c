// What follows from commands and frames: plan, verification, control point, touches, the tunnel as drilled.
#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using test::PhantomOperation;

PlannedTunnel phantom_plan_moved() {
  PlannedTunnel plan = test::phantom_plan();
  plan.tunnel.entry_mm.x() += 2;
  return plan;
}

class OperationRules : public ::testing::Test {
 protected:
  void SetUp() override {
    const SourceSetup source = test::scripted_source();
    run_.start(source);
    run_.show(run_.frame());
  }
  void give() {
    run_.apply(test::true_registration(trial_, run_.operation().now()));
    ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  }
  [[nodiscard]] Eigen::Vector3d on_bone(double dx_mm, double lifted_mm = 0) const {
    return test::on_bone(trial_, dx_mm, lifted_mm);
  }
  experiments::Trial trial_ = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  PhantomOperation run_;
};

// Guidance keeps the plan in force until the edited one is taken over.
TEST_F(OperationRules, AnEditedPlanIsOfferedAndNotTakenUnasked) {
  PlannedTunnel edited = test::phantom_plan();
  edited.tunnel.entry_mm.x() += 2;
  run_.apply(OfferPlan{test::phantom_plan()});
  EXPECT_FALSE(run_.state()->plan_was_edited) << "it is the same";
  run_.apply(OfferPlan{edited});
  EXPECT_TRUE(run_.state()->plan_was_edited);
  EXPECT_EQ(run_.state()->plan->tunnel.entry_mm, test::phantom_plan().tunnel.entry_mm);
  EXPECT_EQ(run_.state()->next_action, NextAction::TakePlanOver);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->plan->tunnel.entry_mm, test::phantom_plan().tunnel.entry_mm);
  run_.apply(TakePlanOver{});
  EXPECT_FALSE(run_.state()->plan_was_edited);
  EXPECT_EQ(run_.state()->plan->tunnel.entry_mm, edited.tunnel.entry_mm);
  const auto told = std::find_if(run_.journal.rbegin(), run_.journal.rend(),
                                 [](const auto& entry) { return entry.kind == JournalKind::Plan; });
  ASSERT_NE(told, run_.journal.rend());
  EXPECT_EQ(told->plan->tunnel.entry_mm, edited.tunnel.entry_mm);
  run_.apply(OfferPlan{});
  EXPECT_TRUE(run_.state()->plan.has_value());
  run_.apply(OfferPlan{edited});
  EXPECT_FALSE(run_.state()->plan_was_edited) << "the edit was undone";
}

// A plan that comes into force is where the registration is judged from then on: taken over, or offered while
// no source runs. A record that knows nothing of that runs again as it ran.
TEST_F(OperationRules, ThePlanInForceIsWhatTheRegistrationAimsAt) {
  PlannedTunnel moved = test::phantom_plan();
  moved.tunnel.entry_mm.x() += 2;
  Operation& operation = run_.operation();
  const auto aims = [&] {
    std::vector<AimAt> found;
    for (const RegistrationRequest& request : operation.take_requests())
      if (const auto* aim = std::get_if<AimAt>(&request)) found.push_back(*aim);
    return found;
  };
  (void)aims();
  operation.apply(OfferPlan{moved});
  EXPECT_TRUE(aims().empty()) << "it is offered alone";
  operation.apply(TakePlanOver{});
  auto asked = aims();
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked.front().target_in_bone_mm, moved.tunnel.entry_mm);
  EXPECT_EQ(asked.front().direction_in_bone, moved.tunnel.direction);
  operation.end_source();
  operation.apply(OfferPlan{test::phantom_plan()});
  asked = aims();
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked.front().target_in_bone_mm, test::phantom_plan().tunnel.entry_mm);
  operation.apply(OfferPlan{});
  asked = aims();
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_FALSE(asked.front().target_in_bone_mm);
  operation.apply(OfferPlan{moved, false});
  EXPECT_EQ(run_.state()->plan, moved);
  EXPECT_TRUE(aims().empty()) << "of before there was this";
}

// What was seen of the guide was relative to the plan before.
TEST_F(OperationRules, AnotherPlanForgetsTheEvidenceOfDrilling) {
  give();
  for (int i = 0; i < 30; ++i) run_.show_guide(0.5);
  EXPECT_TRUE(run_.state()->drilled.has_evidence);
  PlannedTunnel edited = test::phantom_plan();
  edited.length_mm += 2;
  run_.apply(OfferPlan{edited});
  run_.apply(TakePlanOver{});
  EXPECT_FALSE(run_.state()->drilled.has_evidence);
}

// Guidance that begins without a touch that verifies is not refused, and it is recorded, once.
TEST_F(OperationRules, VerificationIsAskedForAndSkippingItIsRecorded) {
  give();
  run_.apply(Draw{false});
  EXPECT_EQ(run_.state()->verification, Verification::NotYet);
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  for (int i = 0; i < 3; ++i) run_.show_guide(-5);
  EXPECT_EQ(run_.state()->verification, Verification::Skipped);
  EXPECT_EQ(run_.count(JournalKind::VerificationSkipped), 1);
  EXPECT_NE(run_.last_text(JournalKind::VerificationSkipped), "");
  give();
  EXPECT_EQ(run_.state()->verification, Verification::NotYet) << "of another registration nothing was said";
  run_.apply(SkipVerification{});
  EXPECT_EQ(run_.state()->verification, Verification::Skipped);
  EXPECT_EQ(run_.last_text(JournalKind::VerificationSkipped), "asked for");
  for (const double dx_mm : {0.0, 4.0, -4.0}) run_.touch(on_bone(dx_mm));
  EXPECT_EQ(run_.state()->verification, Verification::ByTouches);
  EXPECT_EQ(run_.count(JournalKind::Verified), 1);
}

// Enough places were touched, one of them 1.2 mm off the bone: no touch more can verify, and none is asked
// for. More strokes may, and then all of them are registered.
TEST_F(OperationRules, TouchesThatDenyARegistrationAskForStrokesAndNotForTouches) {
  give();
  run_.apply(Draw{false});
  for (const double dx_mm : {0.0, 4.0}) run_.touch(on_bone(dx_mm));
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  run_.touch(on_bone(-4, 1.2));
  ASSERT_EQ(run_.state()->verification, Verification::NotYet);
  ASSERT_EQ(run_.state()->registration->in_force.standing, Standing::Stands);
  EXPECT_EQ(run_.state()->next_action, NextAction::RegisterAnew);
  run_.apply(Draw{true});
  EXPECT_EQ(run_.state()->next_action, NextAction::GoOnDrawing) << "nothing was drawn yet";
  run_.show_tip(on_bone(0));
  EXPECT_EQ(run_.state()->next_action, NextAction::RegisterStrokes);
  run_.apply(ForgetTouches{});
  run_.apply(Draw{false});
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch) << "the touches were wrong";
}

TEST_F(OperationRules, SkippingWithoutARegistrationIsNothing) {
  run_.apply(SkipVerification{});
  EXPECT_EQ(run_.state()->verification, Verification::NotYet);
  EXPECT_EQ(run_.count(JournalKind::VerificationSkipped), 0);
}

// Asked for after registration, after the marker was lost for 30 s, and before drilling when it was touched
// more than five minutes ago.
TEST_F(OperationRules, TheControlPointIsDueWhenTheMarkerMayHaveMoved) {
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None) << "nothing is registered";
  give();
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::Set);
  const Eigen::Vector3d control = on_bone(6);
  run_.touch(control, TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);

  run_.wait(29);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);
  pipeline::FrameResult lost = run_.frame();
  lost.camera_from_world.is_valid = false;
  run_.show(lost);
  run_.wait(31);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckAfterLoss);
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  run_.apply(SkipVerification{});
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckControlPoint);
  run_.touch(control, TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);

  run_.show_guide(-8);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None) << "it was touched just now";
  for (int i = 0; i < 16; ++i) {
    run_.wait(20);
    run_.show_guide(-8);
  }
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckBeforeDrilling);
}

// A guide that is lost for a picture, or for a second, asks for nothing else; one that was put down does.
// Once it has stood where it must to drill, a control point comes too late: what is asked is whether it is
// drilled.
TEST_F(OperationRules, WhatIsNextStaysWhileTheGuideIsLostForAMoment) {
  give();
  run_.apply(SkipVerification{});
  EXPECT_EQ(run_.state()->next_action, NextAction::SetControlPoint);
  run_.show_guide(-8);
  EXPECT_EQ(run_.state()->next_action, NextAction::FollowBullseye);
  for (int i = 0; i < 60; ++i) {
    if (i % 3 == 0)
      run_.show(run_.frame());
    else
      run_.show_guide(-8);
    ASSERT_EQ(run_.state()->next_action, NextAction::FollowBullseye) << i;
  }
  run_.wait(1);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->next_action, NextAction::FollowBullseye);
  run_.wait(1.5);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->next_action, NextAction::SetControlPoint);
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  EXPECT_EQ(run_.state()->next_action, NextAction::RecordDrilled);
  run_.wait(20);
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->next_action, NextAction::RecordDrilled) << "drilled, and the guide put down";
}

// Between two sources nobody saw the marker, and how long that was nobody knows: the control point is asked
// for again before anything guides on.
TEST_F(OperationRules, Hazard25BetweenTwoSourcesTheMarkerWasOutOfSight) {
  give();
  run_.touch(on_bone(6), TouchControlPoint{});
  run_.apply(SkipVerification{});
  ASSERT_EQ(run_.state()->control_point_due, ControlPointDue::None);
  run_.operation().end_source();
  run_.start(test::scripted_source());
  run_.show(run_.frame());
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckAfterLoss);
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckControlPoint);
  run_.touch(on_bone(6), TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);
}

// A loss that is told once is over with the touch, whatever source it was in.
TEST_F(OperationRules, ABumpedMarkerEndsGuidanceUntilItIsSaidWhatItWas) {
  give();
  const Eigen::Vector3d control = on_bone(6), bump(0, 0, 2.4);
  run_.touch(control, TouchControlPoint{});
  run_.touch(control + bump, TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  run_.touch(control + bump, TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
  EXPECT_FALSE(run_.in_force().registration->reliable);
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckWorldMarker);
  EXPECT_EQ(run_.count(JournalKind::Alarm), 1);
  run_.apply(ForgetTouches{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_EQ(run_.last_text(JournalKind::Alarm), "") << "the alarm is over";
}

// The surgeon's word without a guide that stood on the bone records nothing.
TEST_F(OperationRules, ATunnelThatNobodyDrilledIsNotRecorded) {
  give();
  for (int i = 0; i < 60; ++i) run_.show_guide(-4);
  EXPECT_FALSE(run_.state()->drilled.has_evidence);
  run_.apply(TunnelDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NoEvidence);
  EXPECT_FALSE(run_.state()->drilled.tunnel);
  EXPECT_EQ(run_.count(JournalKind::Drilled), 0);
}

// Evidence alone records nothing either; both together do, with the depth that the surgeon read.
TEST_F(OperationRules, DrilledIsTheSurgeonsWordWithEvidence) {
  give();
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  EXPECT_TRUE(run_.state()->drilled.has_evidence);
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NotSaid);
  EXPECT_EQ(run_.count(JournalKind::Drilled), 0);
  run_.apply(ReadDepthStop{24.5});
  run_.apply(TunnelDrilled{});
  ASSERT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  EXPECT_EQ(run_.state()->drilled.tunnel->depth_mm, 24.5);
  EXPECT_EQ(run_.count(JournalKind::Drilled), 1);
  EXPECT_EQ(run_.state()->next_action, NextAction::Finish);
}

// Said too early: it is as if it had not been said, but for the journal. What is recorded afterwards rests on
// what was seen since.
TEST_F(OperationRules, DrilledThatWasSaidTooEarlyIsTakenBack) {
  give();
  run_.apply(TakeBackDrilled{});
  EXPECT_EQ(run_.count(JournalKind::DrilledTakenBack), 0) << "nothing was said";
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TunnelDrilled{});
  ASSERT_EQ(run_.state()->next_action, NextAction::Finish);
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TakeBackDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NotSaid);
  EXPECT_TRUE(run_.state()->drilled.was_taken_back);
  EXPECT_FALSE(run_.state()->drilled.tunnel);
  EXPECT_FALSE(run_.state()->drilled.has_evidence) << "that was of before";
  EXPECT_EQ(run_.count(JournalKind::DrilledTakenBack), 1);
  EXPECT_EQ(run_.state()->next_action, NextAction::FollowBullseye);
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  EXPECT_EQ(run_.state()->next_action, NextAction::RecordDrilled);
  run_.apply(TunnelDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  EXPECT_FALSE(run_.state()->drilled.was_taken_back);
  EXPECT_EQ(run_.count(JournalKind::Drilled), 2);
}

TEST_F(OperationRules, DrilledByWordAloneIsTakenBackToo) {
  give();
  run_.apply(TunnelDrilled{});
  run_.apply(TakeBackDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NotSaid);
  EXPECT_EQ(run_.count(JournalKind::DrilledTakenBack), 1);
}

// A second press with nothing new seen takes nothing away of what is recorded.
TEST_F(OperationRules, DrilledSaidOnceMoreKeepsWhatIsRecorded) {
  give();
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TunnelDrilled{});
  run_.apply(TunnelDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  EXPECT_TRUE(run_.state()->drilled.tunnel);
}

// A guide's end stays on the bone: how deep the drill went nobody has seen, and nobody read it for this hole.
TEST_F(OperationRules, Hazard7ADepthThatNobodyReadIsNotInvented) {
  give();
  run_.apply(ReadDepthStop{24.5});
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TunnelDrilled{});
  ASSERT_TRUE(run_.state()->drilled.tunnel);
  EXPECT_FALSE(run_.state()->depth_stop_mm) << "it was of that hole";
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TunnelDrilled{});
  ASSERT_TRUE(run_.state()->drilled.tunnel);
  EXPECT_FALSE(run_.state()->drilled.tunnel->depth_mm);
  run_.apply(ReadDepthStop{24.5});
  PlannedTunnel other = phantom_plan_moved();
  run_.apply(OfferPlan{other});
  run_.apply(TakePlanOver{});
  EXPECT_FALSE(run_.state()->depth_stop_mm);
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NotSaid);
}

// What a command makes untrue is gone in the state that follows it, not with the next picture.
TEST_F(OperationRules, Hazard5NumbersOfAnotherPlanOrRegistrationAreGoneAtOnce) {
  give();
  run_.show_guide(-4);
  ASSERT_TRUE(run_.state()->frame.guidance.is_valid());
  run_.apply(OfferPlan{phantom_plan_moved()});
  EXPECT_TRUE(run_.state()->frame.guidance.is_valid()) << "the plan in force is the old one";
  run_.apply(TakePlanOver{});
  EXPECT_FALSE(run_.state()->frame.guidance.is_valid());
  run_.show_guide(-4);
  ASSERT_TRUE(run_.state()->frame.guidance.is_valid());
  run_.apply(MarkerPlacedAnew{});
  EXPECT_FALSE(run_.state()->frame.guidance.is_valid());
  give();
  run_.show_guide(-4);
  ASSERT_TRUE(run_.state()->frame.guidance.is_valid());
  run_.operation().end_source();
  EXPECT_FALSE(run_.state()->frame.guidance.is_valid());
  EXPECT_FALSE(run_.state()->frame.camera_from_world.is_valid);
}

// Poses under a registration that does not hold any more are no evidence of a tunnel.
TEST_F(OperationRules, Hazard29EvidenceIsOfOneRegistrationAlone) {
  give();
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  ASSERT_TRUE(run_.state()->drilled.has_evidence);
  give();
  EXPECT_TRUE(run_.state()->drilled.has_evidence) << "the same registration again";
  run_.apply(MarkerPlacedAnew{});
  EXPECT_FALSE(run_.state()->drilled.has_evidence);
  give();
  run_.apply(TunnelDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NoEvidence);
}

// Refused with the reason, and the probe stops drawing: a touch must not be used in the fit.
TEST_F(OperationRules, ATouchNeedsTheTipAtRest) {
  run_.apply(Draw{true});
  run_.apply(TakeTouch{});
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::TipUnknown);
  EXPECT_FALSE(run_.state()->draws);
  for (int i = 0; i < 20; ++i) run_.show_tip({0.3 * i, 0, 0});
  run_.apply(TakeTouch{});
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::TipMoves);
  run_.touch({1, 2, 3});
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::None);
  EXPECT_EQ(run_.state()->registration->touches.count(), 1U);
  run_.operation().end_source();
  run_.apply(TakeTouch{});
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::NoSource);
}

}  // namespace
}  // namespace arthronaut::operation
