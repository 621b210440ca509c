#include "app/navigate/operation_rail.h"

#include <gtest/gtest.h>

#include <set>

#include "app/navigate/live_words.h"

namespace arthronaut::navigate {
namespace {

using operation::NextAction;
using operation::Standing;
using operation::Step;

// An operation to be brought from step to step: the next action follows by the operation's own rule.
struct Course {
  operation::OperationState state;
  operation::SourceSetup source;
  operation::RegistrationState registration;
  tools::ToolSet tools = tools::standard_tools();
  RailContext context;

  Course() {
    source.kind = sources::SourceKind::Live;
    source.pipeline.tools = tools;
    source.pipeline.guide_name = tools::standard_guide_name(bones::BoneKind::Femur);
    context.is_planned = context.has_camera = true;
    context.tools = &tools;
  }
  void plan() { state.plan = operation::PlannedTunnel{{}, 30}; }
  void start() {
    plan();
    state.has_source = true;
    state.frame_count = 1;
    state.source = std::make_shared<const operation::SourceSetup>(source);
  }
  void see_marker() {
    start();
    state.frame.camera_from_world.is_valid = true;
    state.frame.intrinsics_are_known = true;
  }
  void stand() {
    see_marker();
    registration.point_count = 400;
    registration.in_force.standing = Standing::Stands;
    registration.in_force.registration = std::make_shared<const registration::RegistrationSummary>();
  }
  void verify() {
    stand();
    state.verification = operation::Verification::ByTouches;
  }
  [[nodiscard]] Rail rail() {
    state.registration = std::make_shared<const operation::RegistrationState>(registration);
    state.next_action = operation::next_action_of(state);
    return rail_of(state, context);
  }
};

StepState state_of(const Rail& rail, Step step) { return rail[static_cast<std::size_t>(step)].state; }
Missing missing_of(const Rail& rail, Step step) { return rail[static_cast<std::size_t>(step)].missing; }

// One step is now until all is done; the steps stand in their order.
void expect_whole(const Rail& rail) {
  int now = 0;
  for (std::size_t i = 0; i < rail.size(); ++i) {
    EXPECT_EQ(rail[i].step, static_cast<Step>(i));
    now += rail[i].state == StepState::Now ? 1 : 0;
    const bool misses = rail[i].missing != Missing::Nothing;
    EXPECT_FALSE(rail[i].state == StepState::Done && misses) << i;
    EXPECT_FALSE(rail[i].state == StepState::Closed && !misses) << i;
  }
  EXPECT_LE(now, 1);
  EXPECT_TRUE(now == 1 || state_of(rail, Step::Finish) == StepState::Done);
}

// That there is a plan is no tick for one that its own checks call wrong; nothing waits for that.
TEST(OperationRail, APlanIsAsGoodAsItsChecks) {
  using Verdict = tunnels::PlanCheck::Verdict;
  Course course;
  course.source.kind = sources::SourceKind::Simulation;  // whose tools are as they were designed
  course.start();
  EXPECT_EQ(course.rail().front().verdict, Verdict::Fine);
  for (const Verdict verdict : {Verdict::Look, Verdict::Wrong}) {
    course.context.plan_verdict = verdict;
    const Rail rail = course.rail();
    expect_whole(rail);
    EXPECT_EQ(rail.front().state, StepState::Done);
    EXPECT_EQ(rail.front().verdict, verdict);
    for (std::size_t i = 1; i < rail.size(); ++i) EXPECT_EQ(rail[i].verdict, Verdict::Fine) << i;
  }
}

TEST(OperationRail, LeadsThroughTheNineSteps) {
  Course course;
  Rail rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::WorldMarker) << "plan, camera and tools are there: pictures are next";
  EXPECT_EQ(state_of(rail, Step::Plan), StepState::Done);
  EXPECT_EQ(state_of(rail, Step::Digitise), StepState::Closed);
  EXPECT_EQ(missing_of(rail, Step::Verify), Missing::Registration);

  course.start();
  rail = course.rail();
  EXPECT_EQ(step_of_now(rail), Step::WorldMarker);
  EXPECT_EQ(missing_of(rail, Step::WorldMarker), Missing::MarkerInView);

  course.see_marker();
  rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Digitise);
  EXPECT_EQ(state_of(rail, Step::WorldMarker), StepState::Done);
  EXPECT_EQ(missing_of(rail, Step::Register), Missing::Strokes);

  course.registration.point_count = 400;
  course.state.draws = false;
  rail = course.rail();
  EXPECT_EQ(step_of_now(rail), Step::Register);

  course.stand();
  rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Verify);
  EXPECT_EQ(missing_of(rail, Step::Verify), Missing::Touches);
  EXPECT_EQ(state_of(rail, Step::Guide), StepState::Open) << "a look at the way to the plan is free";

  course.verify();
  rail = course.rail();
  EXPECT_EQ(step_of_now(rail), Step::Guide);
  EXPECT_EQ(state_of(rail, Step::Verify), StepState::Done);

  course.state.drilled.outcome = operation::DrilledState::Outcome::Recorded;
  rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Finish);
  EXPECT_EQ(missing_of(rail, Step::Finish), Missing::MarkerOut);
  EXPECT_EQ(state_of(rail, Step::Guide), StepState::Done);

  // The marker is out: what was drilled is the case's to remember, and the operation is at its end.
  course.state.drilled = {};
  course.state.verification = operation::Verification::NotYet;
  course.registration = operation::RegistrationState();
  course.context.is_drilled = course.context.was_measured = course.context.marker_is_out = true;
  rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(state_of(rail, Step::Finish), StepState::Done);
  EXPECT_EQ(state_of(rail, Step::Register), StepState::Done) << "it was, and is not asked for again";
  EXPECT_EQ(state_of(rail, Step::WorldMarker), StepState::Done)
      << "it was placed, and is out as it should be";
  EXPECT_NE(state_of(rail, Step::Verify), StepState::Done) << "nobody says that it was";
  course.context.was_verified = true;
  EXPECT_EQ(state_of(course.rail(), Step::Verify), StepState::Done);
}

// One picture that comes too late takes no guide out of the hand: what is to be done does not blink.
TEST(OperationRail, APictureThatComesTooLateSendsForNoGuide) {
  using guidance::GuidanceState;
  Course course;
  course.verify();
  course.state.frame.guidance.state = GuidanceState::NoGuide;
  (void)course.rail();
  EXPECT_EQ(course.state.next_action, operation::NextAction::BringGuide);
  for (const GuidanceState state : {GuidanceState::PictureLate, GuidanceState::PicturesSlow}) {
    course.state.frame.guidance.state = state;
    (void)course.rail();
    EXPECT_EQ(course.state.next_action, operation::NextAction::FollowBullseye);
  }
}

// A tunnel that was only said to be drilled brings the finish, and no tick to a step that nobody took.
TEST(OperationRail, ATunnelByWordAloneTicksNoStepBeforeIt) {
  Course course;
  course.see_marker();
  course.state.drilled.outcome = operation::DrilledState::Outcome::NoEvidence;
  course.context.is_drilled = true;
  Rail rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Finish);
  for (const Step step : {Step::Digitise, Step::Register, Step::Verify, Step::Guide})
    EXPECT_NE(state_of(rail, step), StepState::Done) << name_of(step);

  // Nor once the marker is out, when the operation itself has forgotten how it was said.
  course.state.drilled = {};
  course.context.marker_is_out = true;
  rail = course.rail();
  for (const Step step : {Step::Digitise, Step::Register, Step::Verify, Step::Guide})
    EXPECT_NE(state_of(rail, step), StepState::Done) << name_of(step);

  // Of one that stands it is said that nothing shows the drilling.
  Course verified;
  verified.verify();
  verified.state.drilled.outcome = operation::DrilledState::Outcome::NoEvidence;
  EXPECT_EQ(state_of(verified.rail(), Step::Guide), StepState::Open);
  EXPECT_EQ(missing_of(verified.rail(), Step::Guide), Missing::Evidence);
}

// The finish is that of both bones: no tick while the list below it names one that is not drilled.
TEST(OperationRail, TheFinishIsDoneWithBothBones) {
  Course course;
  course.plan();
  course.context.is_drilled = course.context.was_measured = course.context.marker_is_out = true;
  course.context.other_bone_is_left = true;
  const Rail rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(state_of(rail, Step::Finish), StepState::Now);
  EXPECT_EQ(missing_of(rail, Step::Finish), Missing::OtherBone);
  course.context.other_bone_is_left = false;
  EXPECT_EQ(state_of(course.rail(), Step::Finish), StepState::Done);
}

// Pictures that end on the way to the tunnel take nothing back: the marker was found, and what is left to do
// is the tunnel, by other pictures.
TEST(OperationRail, PicturesThatEndLeaveTheWayToTheTunnel) {
  Course course;
  course.verify();
  course.state.has_source = false;
  course.state.frame.camera_from_world.is_valid = false;
  const Rail rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Guide);
  EXPECT_EQ(missing_of(rail, Step::Guide), Missing::Source);
  EXPECT_EQ(state_of(rail, Step::WorldMarker), StepState::Done);

  // Before anything stands they are what is missing.
  Course early;
  early.start();
  early.state.has_source = false;
  EXPECT_EQ(step_of_now(early.rail()), Step::WorldMarker);
  EXPECT_EQ(missing_of(early.rail(), Step::WorldMarker), Missing::Source);
}

// Guidance goes on without a verification that was skipped; a tick would say that it was done.
TEST(OperationRail, ASkippedVerificationIsNotTicked) {
  Course course;
  course.stand();
  course.state.verification = operation::Verification::Skipped;
  course.state.guided_lately = true;
  const Rail rail = course.rail();
  expect_whole(rail);
  EXPECT_EQ(step_of_now(rail), Step::Guide);
  EXPECT_EQ(state_of(rail, Step::Verify), StepState::Open);
  EXPECT_EQ(missing_of(rail, Step::Verify), Missing::Touches);
  // Nor does the tunnel tick it.
  course.state.drilled.outcome = operation::DrilledState::Outcome::Recorded;
  EXPECT_EQ(state_of(course.rail(), Step::Verify), StepState::Open);
  EXPECT_EQ(state_of(course.rail(), Step::Register), StepState::Done);
}

// What is missing is named on the step that misses it.
TEST(OperationRail, NamesWhatIsMissing) {
  Course course;
  course.context.is_planned = false;
  EXPECT_EQ(missing_of(course.rail(), Step::Plan), Missing::Plan);
  EXPECT_EQ(step_of_now(course.rail()), Step::Plan);
  course.context.must_choose = true;
  EXPECT_EQ(missing_of(course.rail(), Step::Plan), Missing::TunnelChoice);

  Course no_camera;
  no_camera.context.has_camera = false;
  EXPECT_EQ(step_of_now(no_camera.rail()), Step::Calibrate);
  EXPECT_EQ(missing_of(no_camera.rail(), Step::Calibrate), Missing::Camera);
  EXPECT_EQ(missing_of(no_camera.rail(), Step::WorldMarker), Missing::Camera);

  Course no_axis;
  for (tools::Tool& tool : no_axis.tools.tools) tool.axis.reset();
  no_axis.context.tools = &no_axis.tools;
  EXPECT_EQ(step_of_now(no_axis.rail()), Step::Tools);
  EXPECT_EQ(missing_of(no_axis.rail(), Step::Tools), Missing::GuideAxis);
  for (tools::Tool& tool : no_axis.tools.tools) tool.tip_mm.reset();
  EXPECT_EQ(missing_of(no_axis.rail(), Step::Tools), Missing::ProbeTip);

  Course slipped;
  slipped.verify();
  slipped.state.frame.lens.zoom_or_slip = true;
  EXPECT_EQ(missing_of(slipped.rail(), Step::Calibrate), Missing::LensUnchanged);
  EXPECT_EQ(step_of_now(slipped.rail()), Step::Calibrate);

  Course due;
  due.verify();
  due.state.time_out = operation::TimeOut::Due;
  for (const Step step : {Step::Register, Step::Verify, Step::Guide}) {
    EXPECT_EQ(missing_of(due.rail(), step), Missing::TimeOut);
    EXPECT_NE(state_of(due.rail(), step), StepState::Done);
  }
  Course unconfirmed;  // nothing is drawn or touched before
  unconfirmed.see_marker();
  unconfirmed.state.time_out = operation::TimeOut::Due;
  EXPECT_EQ(missing_of(unconfirmed.rail(), Step::Digitise), Missing::TimeOut);
  unconfirmed.state.draws = false;
  for (const Step step : {Step::Digitise, Step::Verify})
    EXPECT_EQ(repeat_of(step, unconfirmed.state, false), Repeat::NothingNow);

  Course bumped;
  bumped.verify();
  bumped.registration.alarm.kind = operation::TouchAlarm::Kind::ControlPointMoved;
  bumped.registration.in_force.standing = Standing::Alarm;
  EXPECT_EQ(missing_of(bumped.rail(), Step::WorldMarker), Missing::MarkerInPlace);
  EXPECT_NE(state_of(bumped.rail(), Step::Guide), StepState::Done);

  Course nominal;
  nominal.verify();
  nominal.state.guide_check.standing = operation::GuideStanding::Due;
  EXPECT_EQ(missing_of(nominal.rail(), Step::Verify), Missing::GuideCheck);
  EXPECT_EQ(missing_of(nominal.rail(), Step::Guide), Missing::GuideCheck);
}

// That there are tools is no tick for tools of which nobody measured one that registers or guides. The
// simulator's are as they were designed.
TEST(OperationRail, ToolsThatNobodyMeasuredAreNoTick) {
  using Verdict = tunnels::PlanCheck::Verdict;
  const auto verdict_of = [](const Rail& rail) {
    return rail[static_cast<std::size_t>(Step::Tools)].verdict;
  };
  Course course;
  course.context.simulates = false;
  for (tools::Tool& tool : course.tools.tools) tool.provenance.origin = provenance::Origin::Measured;
  EXPECT_EQ(state_of(course.rail(), Step::Tools), StepState::Done);
  EXPECT_EQ(verdict_of(course.rail()), Verdict::Fine);
  for (const char* name : {"probe", "femoral guide", "tibial guide"}) {
    Course one = course;
    one.context.tools = &one.tools;
    for (tools::Tool& tool : one.tools.tools)
      if (tool.name == name) tool.provenance.origin = provenance::Origin::Nominal;
    const bool is_used = std::string(name) != "tibial guide";  // it is the femur's operation
    EXPECT_EQ(verdict_of(one.rail()), is_used ? Verdict::Look : Verdict::Fine) << name;
    one.context.simulates = true;
    EXPECT_EQ(verdict_of(one.rail()), Verdict::Fine) << name;
  }
}

// What was calibrated on the simulator is calibrated for its pictures alone: no tick for a real scope, before
// a source and while its recording runs.
TEST(OperationRail, Hazard26WhatIsOfTheSimulatorTicksNothingOfARealScope) {
  Course course;
  course.context.camera_is_simulated = true;
  EXPECT_EQ(missing_of(course.rail(), Step::Calibrate), Missing::CameraOfScope);
  EXPECT_EQ(step_of_now(course.rail()), Step::Calibrate);
  course.context.simulates = true;
  EXPECT_EQ(state_of(course.rail(), Step::Calibrate), StepState::Done);

  course.context.camera_is_simulated = false;
  for (tools::Tool& tool : course.tools.tools) tool.provenance.origin = provenance::Origin::Simulated;
  EXPECT_EQ(state_of(course.rail(), Step::Tools), StepState::Done);
  course.context.simulates = false;
  EXPECT_EQ(missing_of(course.rail(), Step::Tools), Missing::RealTools);

  Course running;
  running.source.camera_is_simulated = true;
  running.source.kind = sources::SourceKind::Simulation;
  running.verify();
  EXPECT_EQ(state_of(running.rail(), Step::Calibrate), StepState::Done);
  running.source.kind = sources::SourceKind::Recording;
  running.start();
  const Rail rail = running.rail();
  expect_whole(rail);
  EXPECT_EQ(missing_of(rail, Step::Calibrate), Missing::CameraOfScope);
  EXPECT_EQ(step_of_now(rail), Step::Guide) << "it goes on";
}

// Everything that is missing has its own words, and so has every way to do a step again.
TEST(OperationRail, HasWordsForEverything) {
  std::set<std::string> missing, repeats;
  for (int i = 1; i <= static_cast<int>(Missing::OtherBone); ++i)
    missing.insert(words_of(static_cast<Missing>(i)));
  EXPECT_EQ(missing.size(), static_cast<std::size_t>(Missing::OtherBone));
  EXPECT_FALSE(missing.contains(""));
  for (int i = 0; i <= static_cast<int>(Repeat::NothingNow); ++i)
    repeats.insert(words_of(static_cast<Repeat>(i), Step::Tools));
  EXPECT_EQ(repeats.size(), static_cast<std::size_t>(Repeat::NothingNow) + 1);
}

// From wherever an operation is, the way back leads through every step before, to the first.
TEST(OperationRail, NothingBlocksTheWayBack) {
  std::optional<Step> step = Step::Finish;
  int count = 0;
  for (; step; step = step_before(*step)) ++count;
  EXPECT_EQ(count, 9);
  Course course;
  course.verify();
  course.state.registration = std::make_shared<const operation::RegistrationState>(course.registration);
  EXPECT_EQ(repeat_of(Step::Digitise, course.state, false), Repeat::Draw);
  EXPECT_EQ(repeat_of(Step::Register, course.state, false), Repeat::RegisterAnew);
  EXPECT_EQ(repeat_of(Step::Verify, course.state, false), Repeat::Touch);
  EXPECT_EQ(repeat_of(Step::Plan, course.state, false), Repeat::ShowPlan);
  EXPECT_EQ(repeat_of(Step::Tools, course.state, false), Repeat::ShowSetUp);
  EXPECT_EQ(repeat_of(Step::WorldMarker, course.state, false), Repeat::NothingNow)
      << "there is no control point";
}

// The pictures have ended before what stands was verified: that is what is left, and the way on leads by it.
// In those of a drill that have ended the pedal asks whether it is drilled; a step back has other pictures.
TEST(OperationRail, WhatEndedPicturesLeaveOpenIsTheStepOfNow) {
  Course course;
  course.stand();
  course.state.source = std::make_shared<const operation::SourceSetup>();  // of the simulation
  course.state.has_source = false;
  EXPECT_EQ(step_of_now(course.rail()), Step::Verify);
  course.state.verification = operation::Verification::Skipped;
  EXPECT_EQ(step_of_now(course.rail()), Step::Guide);
  course.state.registration = std::make_shared<const operation::RegistrationState>(course.registration);
  EXPECT_EQ(repeat_of(Step::Guide, course.state, false), Repeat::ShowGuide);
  course.state.next_action = operation::NextAction::RecordDrilled;
  EXPECT_EQ(repeat_of(Step::Guide, course.state, false), Repeat::OtherPictures);
}

// A press too early says that it is drilled: the way back takes that back, however it was recorded.
TEST(OperationRail, WhatWasSaidTooEarlyIsTakenBack) {
  using Outcome = operation::DrilledState::Outcome;
  Course course;
  course.verify();
  course.state.drilled.has_evidence = true;
  EXPECT_EQ(repeat_of(Step::Guide, course.state, false), Repeat::ShowGuide) << "the step of now says it";
  for (const Outcome outcome : {Outcome::Recorded, Outcome::NoEvidence}) {
    course.state.drilled.outcome = outcome;
    EXPECT_EQ(repeat_of(Step::Guide, course.state, false), Repeat::NotDrilled);
  }
  course.state.drilled.outcome = Outcome::NotSaid;
  EXPECT_EQ(repeat_of(Step::Guide, course.state, true), Repeat::NotDrilled)
      << "said while another source ran";
}

}  // namespace
}  // namespace arthronaut::navigate
