// What follows from touches: verification, the control point, an alarm.
#include "tests/navigation/operation/operation_rules.h"

namespace arthronaut::operation {
namespace {

using OperationRules = test::OperationRules;

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

// What was touched before is told with it.
TEST_F(OperationRules, ASkippedVerificationSaysWhichTouchesHadBeenTaken) {
  const auto skipped_after = [&](std::initializer_list<double> lifted_mm) {
    give();
    run_.apply(Draw{false});
    run_.apply(ForgetTouches{});
    double dx_mm = -8;
    for (const double lifted : lifted_mm) run_.touch(on_bone(dx_mm += 4, lifted));
    for (int i = 0; i < 3; ++i) run_.show_guide(-5);
    return run_.last_text(JournalKind::VerificationSkipped);
  };
  EXPECT_EQ(skipped_after({}), "guidance began without one");
  EXPECT_EQ(skipped_after({0, 0}), "guidance began without one; 2 of 3 touches had been taken");
  EXPECT_EQ(skipped_after({0, 0, 1.2}),
            "guidance began without one; 3 of 3 touches had been taken, too far off to verify");
}

// A drill with a marker of its own that stands at the plan guides as well: the hand follows its numbers,
// whatever keeps the guide's away.
TEST_F(OperationRules, ADrillAtThePlanSkipsTheVerificationToo) {
  give();
  run_.apply(Draw{false});
  const auto show_drill = [&](double beside_mm) {
    const PlannedTunnel plan = test::phantom_plan();
    const Eigen::Vector3d beside = beside_mm * plan.tunnel.direction.unitOrthogonal();
    pipeline::FrameResult frame = run_.frame();
    frame.guidance.state = guidance::GuidanceState::GuideLost;
    frame.guidance.timestamp_ns = frame.timestamp_ns;
    frame.guidance.drill = guidance::drill_depth(plan.tunnel, plan.length_mm,
                                                 plan.tunnel.entry_mm + beside - plan.tunnel.direction,
                                                 plan.tunnel.direction, 0.3);
    run_.show(frame);
  };
  show_drill(60);
  EXPECT_EQ(run_.count(JournalKind::VerificationSkipped), 0) << "it lies in its tray";
  for (int i = 0; i < 3; ++i) show_drill(1);
  EXPECT_EQ(run_.state()->verification, Verification::Skipped);
  EXPECT_EQ(run_.count(JournalKind::VerificationSkipped), 1);
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

// Lost for long, or between two live sources, with no control point of before: nothing old can be held
// against where the marker sits now. What is set then has learned that already, and ends nothing.
TEST_F(OperationRules, Hazard25WithoutAControlPointALossAsksForTouchesAnew) {
  const auto lose = [&] {
    pipeline::FrameResult lost = run_.frame();
    lost.camera_from_world.is_valid = false;
    run_.show(lost);
    run_.wait(31);
    run_.show(run_.frame());
  };
  const auto begin_another = [&] {
    run_.operation().end_source();
    run_.start(test::scripted_source());
    run_.show(run_.frame());
  };
  const std::vector<std::function<void()>> out_of_sight{lose, begin_another};
  for (const auto& nobody_saw_it : out_of_sight) {
    run_.apply(MarkerPlacedAnew{});
    give();
    run_.apply(Draw{false});
    for (const double dx_mm : {0.0, 4.0, -4.0}) run_.touch(on_bone(dx_mm));
    ASSERT_EQ(run_.state()->verification, Verification::ByTouches);
    const long lost_before = run_.count(JournalKind::VerificationLost);
    nobody_saw_it();
    ASSERT_EQ(run_.in_force().standing, Standing::Stands);
    EXPECT_EQ(run_.state()->verification, Verification::NotYet);
    EXPECT_EQ(run_.count(JournalKind::VerificationLost), lost_before + 1);
    const auto expect_asked_for = [&](int places) {
      EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLoss);
      EXPECT_EQ(run_.state()->places_in_doubt, places);
      EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
    };
    expect_asked_for(3);
    for (int press = 0; press < 2; ++press) run_.touch(on_bone(6), TouchControlPoint{});
    expect_asked_for(3);
    run_.show_guide(-5);
    expect_asked_for(3);
    run_.touch(on_bone(0));
    run_.touch(on_bone(4));
    expect_asked_for(1);
    EXPECT_NE(run_.state()->verification, Verification::ByTouches) << "those of before do not count";
    run_.touch(on_bone(-4));
    EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);
    EXPECT_EQ(run_.state()->verification, Verification::ByTouches);
    lose();
    EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckAfterLoss)
        << "now there is one of before";
    EXPECT_EQ(run_.state()->verification, Verification::ByTouches);
  }
}

// Touches that lay off the bone before the loss stay what they were: they speak against the registration.
TEST_F(OperationRules, Hazard25ALossTakesNoTouchAwayThatLiesOffTheBone) {
  give();
  run_.touch(on_bone(8, 5));
  run_.operation().end_source();
  run_.start(test::scripted_source());
  run_.show(run_.frame());
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  run_.touch(on_bone(-8, 5));
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
}

// Nothing was measured yet, or nothing of it is left: a marker that moved made nothing wrong.
TEST_F(OperationRules, ALossBeforeAnythingWasMeasuredAsksForNothing) {
  const auto lose = [&] {
    run_.wait(31);
    run_.show(run_.frame());
  };
  lose();
  give();
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::Set);
  lose();
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLoss);
  run_.apply(MarkerPlacedAnew{});
  give();
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::Set);
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

// Touched again and found elsewhere, a control point answers nothing: it is asked for once more, before all
// else, until it lies where it lay or tells an alarm.
TEST_F(OperationRules, AControlPointThatLiesElsewhereIsAskedForAgain) {
  give();
  const Eigen::Vector3d control = on_bone(6), slip(0, 0, 2.4);
  run_.touch(control, TouchControlPoint{});
  run_.apply(SkipVerification{});
  pipeline::FrameResult lost = run_.frame();
  lost.camera_from_world.is_valid = false;
  run_.show(lost);
  run_.wait(31);
  run_.show(run_.frame());
  ASSERT_EQ(run_.state()->control_point_due, ControlPointDue::CheckAfterLoss);
  run_.touch(control + slip, TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands) << "the probe may have slipped";
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckShift);
  run_.show_guide(-5);
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckControlPoint) << "whatever is in view";
  run_.touch(control, TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None) << "it had slipped";

  run_.touch(control + slip, TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckShift) << "nobody had asked for it";
  run_.touch(control + slip, TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
}

// What touches verified is not verified any more once one lies off the bone, or they are said to be wrong.
TEST_F(OperationRules, AVerificationEndsWithItsTouches) {
  give();
  run_.apply(Draw{false});
  const auto verify = [&] {
    for (const double dx_mm : {0.0, 4.0, -4.0}) run_.touch(on_bone(dx_mm));
    ASSERT_EQ(run_.state()->verification, Verification::ByTouches);
    ASSERT_TRUE(run_.in_force().is_verified);
  };
  verify();
  run_.touch(on_bone(8, 5));
  EXPECT_EQ(run_.in_force().standing, Standing::Stands) << "one alone is no alarm";
  EXPECT_FALSE(run_.in_force().is_verified);
  EXPECT_EQ(run_.state()->verification, Verification::NotYet);
  EXPECT_EQ(run_.count(JournalKind::VerificationLost), 1);
  EXPECT_EQ(run_.state()->next_action, NextAction::RegisterAnew) << "no further touch can verify";
  run_.apply(ForgetTouches{});
  EXPECT_EQ(run_.count(JournalKind::VerificationLost), 1) << "that was said";
  verify();
  run_.apply(ForgetTouches{});
  EXPECT_FALSE(run_.in_force().is_verified);
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  EXPECT_EQ(run_.count(JournalKind::VerificationLost), 2);
  EXPECT_EQ(run_.count(JournalKind::Verified), 2);
}

// All ways that end what was found end the same of it, and the record says which it was.
TEST_F(OperationRules, WhatIsFoundAnewIsRecordedWithItsReason) {
  const auto recorded = [&] {
    const auto told = std::find_if(run_.journal.rbegin(), run_.journal.rend(), [](const JournalEntry& entry) {
      return entry.kind == JournalKind::RegistrationInForce;
    });
    return told->registration->has_pose ? "" : told->registration->reasons.front();
  };
  give();
  for (const double dx_mm : {8.0, -8.0}) run_.touch(on_bone(dx_mm, 5));
  ASSERT_EQ(run_.in_force().standing, Standing::Alarm);
  run_.apply(ClearStrokes{});
  EXPECT_EQ(run_.in_force().standing, Standing::None);
  EXPECT_EQ(recorded(), "all was cleared in an alarm");
  give();
  run_.apply(MarkerPlacedAnew{});
  EXPECT_EQ(recorded(), "the world marker was placed anew");
  give();
  run_.operation().end_source();
  run_.apply(MarkerOut{});
  EXPECT_EQ(recorded(), "the world marker is out of the bone");
}

// Two touches off the bone, told as an alarm and then as wrong, leave nothing verified.
TEST_F(OperationRules, AnAlarmOfTouchesThatIsTakenAwayLeavesNothingVerified) {
  give();
  for (const double dx_mm : {0.0, 4.0, -4.0}) run_.touch(on_bone(dx_mm));
  run_.touch(on_bone(8, 5));
  run_.touch(on_bone(-8, 5));
  ASSERT_EQ(run_.in_force().standing, Standing::Alarm);
  run_.apply(ForgetTouches{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_FALSE(run_.in_force().is_verified);
}

}  // namespace
}  // namespace arthronaut::operation
