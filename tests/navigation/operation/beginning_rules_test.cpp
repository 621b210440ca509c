// How an operation begins: the time-out before the first guidance, and going on with one that was cut off.
#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

const experiments::Trial& trial() {
  static const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return trial;
}

GiveRegistration given(PhantomOperation& run, const SourceSetup& source) {
  return test::true_registration(trial(), provenance_of(run.operation().setup(), source));
}

guidance::GuidanceState shown(PhantomOperation& run) {
  run.show_guide(-5);
  return run.state()->frame.guidance.state;
}

// A live source guides nothing, verifies nothing by itself and takes nothing for evidence before patient,
// side, plan, camera, tools and medium were confirmed; that they were is one command and stands in the
// journal.
TEST(TimeOut, Hazard20NothingGuidesLiveBeforeItIsConfirmed) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start_unconfirmed(source);
  EXPECT_EQ(run.state()->time_out, TimeOut::Due);
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmTimeOut);
  run.apply(given(run, source));
  ASSERT_EQ(run.in_force().standing, Standing::Stands);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(shown(run), guidance::GuidanceState::NotConfirmed);
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmTimeOut);
  EXPECT_FALSE(run.state()->drilled.has_evidence);
  EXPECT_EQ(run.state()->verification, Verification::NotYet);
  EXPECT_EQ(run.count(JournalKind::TimeOutConfirmed), 0);
  run.apply(ConfirmTimeOut{true});
  EXPECT_EQ(run.state()->time_out, TimeOut::Confirmed);
  EXPECT_EQ(shown(run), guidance::GuidanceState::Valid);
  ASSERT_EQ(run.count(JournalKind::TimeOutConfirmed), 1);
  const std::string told = run.last_text(JournalKind::TimeOutConfirmed);
  EXPECT_EQ(told.find("right femur, patient shown, plan 9.0 mm wide and 30.0 mm long, mesh "), 0U) << told;
}

// A drill with a marker of its own is seen without its guide, and guides as little.
TEST(TimeOut, Hazard20NoDrillIsShownOrRememberedBeforeItIsConfirmed) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start_unconfirmed(source);
  run.apply(given(run, source));
  const PlannedTunnel plan = test::phantom_plan();
  const auto show_drill = [&] {
    pipeline::FrameResult frame = run.frame();
    frame.guidance.timestamp_ns = frame.timestamp_ns;
    frame.guidance.drill =
        guidance::drill_depth(plan.tunnel, plan.length_mm, plan.tunnel.entry_mm + 20 * plan.tunnel.direction,
                              plan.tunnel.direction, 0.3);
    run.show(frame);
  };
  for (int i = 0; i < 100; ++i) {
    show_drill();
    ASSERT_FALSE(run.state()->frame.guidance.drill);
  }
  run.apply(ConfirmTimeOut{true});
  run.apply(TunnelDrilled{});
  EXPECT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::NoEvidence) << "it rests on what was before";
  for (int i = 0; i < 100; ++i) show_drill();
  EXPECT_TRUE(run.state()->frame.guidance.drill);
  EXPECT_TRUE(run.state()->drilled.has_evidence);
}

// A stroke or a touch before it would be of a knee that nobody has said is the right one: none is taken, and
// a touch says why. They are from the moment on in which it is confirmed.
TEST(TimeOut, Hazard20NothingIsDrawnOrTouchedBeforeItIsConfirmed) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start_unconfirmed(source);
  const strokes::Curves strokes(trial().curves.begin(), trial().curves.begin() + 200);
  run.draw(strokes);
  EXPECT_FALSE(run.state()->draws);
  EXPECT_EQ(run.state()->registration->point_count, 0U);
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::TimeOutDue);
  run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::TimeOutDue);
  EXPECT_EQ(run.state()->registration->touches.count(), 0U);
  EXPECT_FALSE(run.state()->registration->touches.has_control_point());
  run.apply(ConfirmTimeOut{true});
  EXPECT_TRUE(run.state()->draws) << "what was refused took nothing away";
  run.draw(strokes);
  EXPECT_EQ(run.state()->registration->point_count, strokes.size());
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::None);
  EXPECT_EQ(run.state()->registration->touches.count(), 1U);
}

// What takes an alarm away is a touch: where none is taken, the time-out is what is to be done, or nothing
// went on.
TEST(TimeOut, Hazard20ComesBeforeTheTouchThatAnAlarmAsksFor) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start(source);
  run.apply(given(run, source));
  run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  const Eigen::Vector3d bumped_mm(0, 0, 3);
  for (int i = 0; i < 2; ++i) run.touch(test::on_bone(trial(), 2) + bumped_mm, TouchControlPoint{});
  ASSERT_EQ(run.state()->next_action, NextAction::CheckWorldMarker);
  SourceSetup other_guide = source;
  other_guide.pipeline.tools.tools.back().axis->point_mm.y() -= 20;
  run.start_unconfirmed(other_guide);
  ASSERT_EQ(run.state()->time_out, TimeOut::Due);
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmTimeOut);
  run.apply(ConfirmTimeOut{});
  EXPECT_EQ(run.state()->next_action, NextAction::CheckWorldMarker);
}

// Records of before there was this run again as they ran.
TEST(TimeOut, OfAnOldRecordTakesWhatWasTaken) {
  PhantomOperation run;
  SourceSetup source = test::scripted_source(SourceKind::Live);
  source.time_out_first = false;
  run.start_unconfirmed(source);
  run.draw({trial().curves.begin(), trial().curves.begin() + 200});
  EXPECT_EQ(run.state()->registration->point_count, 200U);
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.state()->registration->touches.count(), 1U);
}

// Of two tunnels in a bone the record says which one was confirmed.
TEST(TimeOut, Hazard38TheRecordNamesTheTunnel) {
  PhantomOperation run;
  PlannedTunnel plan = test::phantom_plan();
  plan.tunnel.bundle = norms::Bundle::Posterolateral;
  run.apply(OfferPlan{plan});  // taken at once: no source runs
  run.start_unconfirmed(test::scripted_source(SourceKind::Live));
  run.apply(ConfirmTimeOut{true});
  const std::string told = run.last_text(JournalKind::TimeOutConfirmed);
  EXPECT_EQ(
      told.find("right femur, patient shown, tunnel femur PL, plan 9.0 mm wide and 30.0 mm long, mesh "), 0U)
      << told;
}

// Nobody is drilled in a recording or a simulation: there it is not asked for.
TEST(TimeOut, IsNotAskedForWhereNobodyIsDrilled) {
  for (const SourceKind kind : {SourceKind::Recording, SourceKind::Simulation}) {
    PhantomOperation run;
    const SourceSetup source = test::scripted_source(kind);
    run.start_unconfirmed(source);
    EXPECT_EQ(run.state()->time_out, TimeOut::NotAsked);
    run.apply(given(run, source));
    EXPECT_EQ(shown(run), guidance::GuidanceState::Valid);
  }
}

// What was confirmed holds for this camera, these tools, guide and drill among them, this medium, this side's
// bone and this plan: with anything else it is asked for again. The same camera opened again goes on; so does
// a marker that was placed anew.
TEST(TimeOut, HoldsForWhatWasConfirmedAlone) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start(source);
  ASSERT_EQ(run.state()->time_out, TimeOut::Confirmed);
  run.start_unconfirmed(source);
  EXPECT_EQ(run.state()->time_out, TimeOut::Confirmed);
  run.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run.state()->time_out, TimeOut::Confirmed);
  PlannedTunnel edited = test::phantom_plan();
  edited.length_mm += 1;
  run.apply(OfferPlan{edited});
  EXPECT_EQ(run.state()->time_out, TimeOut::Confirmed) << "the one in force guides on";
  run.apply(TakePlanOver{});
  EXPECT_EQ(run.state()->time_out, TimeOut::Due);
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmTimeOut);
  run.operation().end_source();
  run.start_unconfirmed(source);
  EXPECT_EQ(run.state()->time_out, TimeOut::Due) << "opening the camera again confirms nothing";
  run.apply(ConfirmTimeOut{});
  ASSERT_EQ(run.state()->time_out, TimeOut::Confirmed);
  run.operation().end_source();
  edited.length_mm += 1;
  run.apply(OfferPlan{edited});  // taken at once: no source runs
  run.start_unconfirmed(source);
  EXPECT_EQ(run.state()->time_out, TimeOut::Due);
  run.apply(ConfirmTimeOut{});
  ASSERT_EQ(run.state()->time_out, TimeOut::Confirmed);
  for (const int what : {0, 1, 2, 3, 4, 5}) {
    SourceSetup other = source;
    if (what == 0) other.pipeline.calibration.focal_px += 1;
    if (what == 1) other.pipeline.refractive_index = 1.3345;
    if (what == 2) other.pipeline.tools.tools.front().marker_id += 20;
    if (what == 3) other.pipeline.tools.tools.back().axis->point_mm.y() -= 20;
    if (what == 4) other.pipeline.tools.tools.back().marker_id += 20;
    if (what == 5) {
      tools::Tool& drill = other.pipeline.tools.tools.emplace_back(other.pipeline.tools.tools.back());
      drill.name = "drill";
      drill.marker_id += 20;
      drill.kind = tools::ToolKind::Drill;
      drill.tip_mm = drill.axis->point_mm;
    }
    run.start_unconfirmed(other);
    EXPECT_EQ(run.state()->time_out, TimeOut::Due) << what;
  }
}

// A plan that was edited is shown before it is taken over, and guides live only when the time-out was
// confirmed of it.
TEST(TimeOut, Hazard5APlanThatIsTakenOverGuidesOnlyAfterAnotherTimeOut) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  run.start(source);
  run.apply(given(run, source));
  run.apply(SkipVerification{});
  ASSERT_EQ(shown(run), guidance::GuidanceState::Valid);
  PlannedTunnel edited = test::phantom_plan();
  edited.tunnel.entry_mm.x() += 1;
  run.apply(OfferPlan{edited});
  EXPECT_EQ(run.state()->edited_plan, edited);
  EXPECT_EQ(shown(run), guidance::GuidanceState::Valid);
  run.apply(TakePlanOver{});
  EXPECT_EQ(run.state()->edited_plan, std::nullopt);
  EXPECT_EQ(run.state()->plan, edited);
  EXPECT_EQ(shown(run), guidance::GuidanceState::NotConfirmed);
  const long told = run.count(JournalKind::TimeOutConfirmed);
  run.apply(ConfirmTimeOut{true});
  EXPECT_EQ(run.count(JournalKind::TimeOutConfirmed), told + 1);
  EXPECT_EQ(shown(run), guidance::GuidanceState::Valid);
}

// A record of before took the word for a confirmation: it runs again as it ran.
TEST(TimeOut, ATakeOverOfAnOlderRecordStaysAConfirmation) {
  PhantomOperation run;
  run.start(test::scripted_source(SourceKind::Live));
  PlannedTunnel edited = test::phantom_plan();
  edited.length_mm += 1;
  run.apply(OfferPlan{edited});
  run.apply(command_from_text(R"({"format":"arthronaut.command","version":1,"command":"take plan over"})",
                              "the record"));
  EXPECT_EQ(run.state()->plan, edited);
  EXPECT_EQ(run.state()->time_out, TimeOut::Confirmed);
}

ResumeOperation left_behind(PhantomOperation& run, const SourceSetup& source) {
  ResumeOperation resume;
  resume.session = "0003";
  resume.of = resume.registration_of = provenance_of(run.operation().setup(), source);
  resume.registration = given(run, source).registration;
  resume.drawn = trial().curves;
  resume.stroke_count = 7;
  resume.touches_mm = {test::on_bone(trial(), 0), test::on_bone(trial(), 5)};
  resume.control_point_mm = test::on_bone(trial(), 2);
  resume.plan = test::phantom_plan();
  resume.depth_stop_mm = 21.5;
  return resume;
}

// All of it is there again; the registration guides nothing until one touch, and what was drawn and touched
// says nothing of the marker as it sits now.
TEST(Resumed, Hazard12BringsAllBackAndGuidesAfterOneTouch) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.apply(left_behind(run, source));
  ASSERT_NE(run.state()->resumed, nullptr);
  EXPECT_EQ(run.state()->resumed->session, "0003");
  EXPECT_EQ(run.state()->next_action, NextAction::StartSource);
  run.start(source);
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  EXPECT_EQ(*run.in_force().mismatch, registration::Mismatch::Placement);
  EXPECT_FALSE(run.state()->draws) << "a touch comes first";
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmByTouch);
  EXPECT_EQ(run.state()->depth_stop_mm, 21.5);
  EXPECT_EQ(run.state()->registration->touches.count(), 2U);
  EXPECT_TRUE(run.state()->registration->touches.has_control_point());
  EXPECT_EQ(run.state()->registration->point_count, 0U) << "no stroke of before is used";
  EXPECT_NE(shown(run), guidance::GuidanceState::Valid);
  run.touch(test::on_bone(trial(), 0, 2));  // off the bone: confirms nothing
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.in_force().standing, Standing::Stands);
  EXPECT_FALSE(run.in_force().is_verified) << "touches of before verify nothing now";
  EXPECT_EQ(shown(run), guidance::GuidanceState::Valid);
}

// Nobody saw the marker between the two: the control point of before is to be touched, as between two live
// sources of one operation.
TEST(Resumed, Hazard25AsksForTheControlPointOfBefore) {
  for (const sources::SourceKind kind : {sources::SourceKind::Live, sources::SourceKind::Recording}) {
    PhantomOperation run;
    const SourceSetup source = test::scripted_source(kind);
    run.apply(left_behind(run, source));
    run.start(source);
    run.touch(test::on_bone(trial(), 0));
    ASSERT_EQ(run.in_force().standing, Standing::Stands);
    const bool is_live = kind == sources::SourceKind::Live;
    EXPECT_EQ(run.state()->control_point_due,
              is_live ? ControlPointDue::CheckAfterLoss : ControlPointDue::None);
    run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    EXPECT_EQ(run.state()->control_point_due, ControlPointDue::None);
  }
}

// On cartilage the probe touches as far off the bone as it did before: no alarm comes of the crash.
TEST(Resumed, TouchesOnCartilageAreJudgedAsBefore) {
  constexpr double kThickness_mm = 2;
  OperationSetup setup = test::phantom_setup();
  const auto& vertices_mm = setup.surface->mesh().vertices_mm;
  setup.cartilage.emplace();
  for (std::size_t i = 0; i < vertices_mm.size(); i += 5)
    setup.cartilage->points_mm.push_back(vertices_mm[i]);
  PhantomOperation run(setup);
  const SourceSetup source = test::scripted_source();
  ResumeOperation resume = left_behind(run, source);
  resume.registration->cartilage_use = registration::CartilageUse::Solved;
  resume.registration->cartilage_thickness_mm = kThickness_mm;
  run.apply(command_from_text(to_text(resume), "the record"));
  run.start(source);
  for (const double dx_mm : {0.0, 4.0}) {
    run.touch(test::on_bone(trial(), dx_mm, kThickness_mm));
    EXPECT_NEAR(run.state()->registration->touches.last().distance_mm.value(), 0, 0.2);
  }
  EXPECT_EQ(run.in_force().standing, Standing::Stands);
}

// Another registration in its place stands for itself: the journal tells of no touch that confirmed anything.
// One void registration after another is told each time.
TEST(Resumed, AnotherRegistrationInItsPlaceIsNoConfirmation) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.apply(left_behind(run, source));
  run.start(source);
  const long told = run.count(JournalKind::Void);
  GiveRegistration again = given(run, source);
  again.is_resumed = true;
  again.registration.marker_from_bone.translation_mm.x() += 0.1;
  run.apply(again);
  EXPECT_EQ(run.count(JournalKind::Void), told + 1);
  run.apply(given(run, source));
  EXPECT_EQ(run.in_force().standing, Standing::Stands);
  EXPECT_EQ(run.count(JournalKind::Confirmed), 0);
}

// The control point of before tells a marker that was bumped meanwhile.
TEST(Resumed, TheControlPointStillTellsABumpedMarker) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.apply(left_behind(run, source));
  run.start(source);
  run.touch(test::on_bone(trial(), 0));
  ASSERT_EQ(run.in_force().standing, Standing::Stands);
  const Eigen::Vector3d bumped_mm(0, 0, 3);
  run.touch(test::on_bone(trial(), 2) + bumped_mm, TouchControlPoint{});
  run.touch(test::on_bone(trial(), 2) + bumped_mm, TouchControlPoint{});
  EXPECT_EQ(run.in_force().standing, Standing::Alarm);
}

// What a simulation left behind is void for good in anything real, and its touches are of no real bone.
TEST(Resumed, OfASimulationIsVoidForGoodInALiveSource) {
  PhantomOperation run;
  run.apply(left_behind(run, test::scripted_source(SourceKind::Simulation)));
  run.start(test::scripted_source(SourceKind::Live));
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  EXPECT_FALSE(run.in_force().can_be_confirmed);
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  EXPECT_FALSE(run.state()->registration->touches.has_control_point());
}

// The plan that guided before guides again; the case's, edited since, waits to be taken over.
TEST(Resumed, TheCasesPlanWaitsWhenItIsAnotherOneByNow) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  ResumeOperation resume = left_behind(run, source);
  resume.plan->tunnel.entry_mm.x() += 1;
  run.apply(resume);
  EXPECT_EQ(run.state()->plan, resume.plan);
  // Told once more, as when a landmark of it was confirmed meanwhile: nobody has taken it over by that.
  run.apply(OfferPlan{test::phantom_plan()});
  EXPECT_EQ(run.state()->plan, resume.plan);
  run.start(source);
  EXPECT_EQ(run.state()->plan, resume.plan);
  EXPECT_TRUE(run.state()->plan_was_edited);
  EXPECT_EQ(run.state()->next_action, NextAction::TakePlanOver);
  run.apply(TakePlanOver{});
  EXPECT_EQ(run.state()->plan, test::phantom_plan());
}

// Once, and at the beginning: nothing of another operation comes into one that goes on.
TEST(Resumed, TakesEffectOnceAndBeforeTheFirstSourceAlone) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.start(source);
  run.apply(left_behind(run, source));
  EXPECT_EQ(run.state()->resumed, nullptr);
  EXPECT_EQ(run.in_force().standing, Standing::None);
  EXPECT_EQ(run.state()->registration->touches.count(), 0U);
  PhantomOperation twice;
  twice.apply(left_behind(twice, source));
  ResumeOperation again = left_behind(twice, source);
  again.session = "0004";
  twice.apply(again);
  EXPECT_EQ(twice.state()->resumed->session, "0003");
  EXPECT_EQ(twice.state()->registration->history->size(), 1U);
}

}  // namespace
}  // namespace arthronaut::operation
