// What follows from commands and frames: plan, verification, control point, touches, the tunnel as drilled.
#include "tests/navigation/operation/operation_rules.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using test::PhantomOperation;
using OperationRules = test::OperationRules;

PlannedTunnel phantom_plan_moved() {
  PlannedTunnel plan = test::phantom_plan();
  plan.tunnel.entry_mm.x() += 2;
  return plan;
}

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

// What is known of a registration is known at the plan in force: where the next plan's entry lies too far
// from what was touched, it does not guide there, and guides again where it is known.
TEST_F(OperationRules, AnotherPlanIsGuidedToAsWellAsTheRegistrationIsKnownThere) {
  GiveRegistration give = test::true_registration(trial_, run_.operation().now());
  const Eigen::Vector3d entry_mm = test::phantom_plan().tunnel.entry_mm;
  // 0.1 mm a coordinate at the entry, and a turn about it of 0.05 rad.
  geometry::Matrix6d about_entry = geometry::Matrix6d::Zero(), to_origin = geometry::Matrix6d::Identity();
  about_entry.topLeftCorner<3, 3>().diagonal().setConstant(0.1 * 0.1);
  about_entry.bottomRightCorner<3, 3>().diagonal().setConstant(0.05 * 0.05);
  to_origin.topRightCorner<3, 3>() = geometry::cross_matrix(entry_mm);
  give.registration.covariance = to_origin * about_entry * to_origin.transpose();
  give.registration.predicted_tre_mm = registration::predicted_error_mm(give.registration, entry_mm);
  run_.apply(give);
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  const auto take_over = [&](double away_mm) {
    PlannedTunnel plan = test::phantom_plan();
    plan.tunnel.entry_mm.x() += away_mm;
    run_.apply(OfferPlan{plan});
    run_.apply(TakePlanOver{});
    const double turned_mm = std::sqrt(2.0) * 0.05 * away_mm;
    EXPECT_NEAR(run_.in_force().registration->predicted_tre_mm, std::hypot(std::sqrt(3.0) * 0.1, turned_mm),
                1e-9);
  };
  take_over(4);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  take_over(40);
  EXPECT_EQ(run_.in_force().standing, Standing::NotReliable);
  EXPECT_FALSE(run_.in_force().registration->reliable);
  take_over(0);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

// What was seen of the guide was relative to the plan before.
TEST_F(OperationRules, AnotherPlanForgetsTheEvidenceOfDrilling) {
  give();
  for (int i = 0; i < 40; ++i) run_.show_guide(0.5);
  EXPECT_TRUE(run_.state()->drilled.has_evidence);
  PlannedTunnel edited = test::phantom_plan();
  edited.length_mm += 2;
  run_.apply(OfferPlan{edited});
  run_.apply(TakePlanOver{});
  EXPECT_FALSE(run_.state()->drilled.has_evidence);
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

// A recording, and the simulator's script, show once what is drilled in them: when their pictures have ended,
// that is what is left to say. After a live source the next thing is the source.
TEST_F(OperationRules, DrilledIsAskedForWhenARecordingOrASimulationHasEnded) {
  using sources::SourceKind;
  for (const SourceKind kind : {SourceKind::Recording, SourceKind::Simulation, SourceKind::Live}) {
    PhantomOperation run;
    run.start(test::scripted_source(kind));
    run.show(run.frame());
    run.apply(test::true_registration(trial_, run.operation().now()));
    for (int i = 0; i < 60; ++i) run.show_guide(0.2);
    run.operation().end_source();
    EXPECT_EQ(run.state()->next_action,
              kind == SourceKind::Live ? NextAction::StartSource : NextAction::RecordDrilled);
    run.apply(TunnelDrilled{});
    EXPECT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
    EXPECT_EQ(run.state()->next_action, NextAction::Finish);
  }
}

// Nobody has to start the sender of before to say that it was too early: this record says so.
TEST_F(OperationRules, DrilledThatWasSaidUnderAnotherSourceIsTakenBack) {
  give();
  for (int i = 0; i < 60; ++i) run_.show_guide(0.2);
  run_.apply(TunnelDrilled{});
  run_.operation().end_source();
  run_.start(test::scripted_source());
  EXPECT_FALSE(run_.state()->drilled.was_taken_back);
  for (int i = 0; i < 2; ++i) run_.apply(TakeBackDrilled{});
  EXPECT_TRUE(run_.state()->drilled.was_taken_back);
  EXPECT_EQ(run_.count(JournalKind::SaidTooEarly), 1) << "once";
  EXPECT_EQ(run_.count(JournalKind::DrilledTakenBack), 0) << "nothing of it is in this record";
}

TEST_F(OperationRules, DrilledByWordAloneIsTakenBackToo) {
  give();
  run_.apply(TunnelDrilled{});
  run_.apply(TakeBackDrilled{});
  EXPECT_EQ(run_.state()->drilled.outcome, DrilledState::Outcome::NotSaid);
  EXPECT_EQ(run_.count(JournalKind::SaidTooEarly), 1);
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
  run_.apply(ConfirmTimeOut{});
  EXPECT_FALSE(run_.state()->frame.guidance.is_valid()) << "the picture's numbers are of the plan before";
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
