// A nominal guide in a live operation: hidden until its tip was found on the control point.
#include "navigation/operation/guide_check.h"

#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using guidance::GuidanceState;
using registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

const experiments::Trial& trial() {
  static const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return trial;
}

SourceSetup nominal_source(SourceKind kind = SourceKind::Live) {
  SourceSetup source = test::scripted_source(kind);
  source.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
  return source;
}

// The guide of these numbers rests with its tip there, turned so.
void hold_guide(PhantomOperation& run, const Eigen::Vector3d& tip_in_marker_mm, int frames = 20,
                double turn_rad = 0.6) {
  const tools::ToolAxis axis = *test::scripted_options().tools.tools.back().axis;
  geometry::RigidTransform world_from_guide;
  world_from_guide.rotation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(1, 2, 3).normalized());
  world_from_guide.translation_mm = tip_in_marker_mm - world_from_guide.rotation * axis.point_mm;
  run.wait(1);
  for (int i = 0; i < frames; ++i) {
    pipeline::FrameResult frame = run.frame();
    frame.tools.back().world_from_tool.is_valid = true;
    frame.tools.back().world_from_tool.target_from_source = world_from_guide;
    run.show(frame);
  }
}

GuidanceState shown(PhantomOperation& run) {
  run.show_guide(-5);
  return run.state()->frame.guidance.state;
}

// Registered, verified and with a control point: what is left is the guide.
void bring_to_the_guide(PhantomOperation& run, const SourceSetup& source) {
  run.start(source);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), source)));
  for (const double dx_mm : {0.0, 4.0, -4.0}) run.touch(test::on_bone(trial(), dx_mm));
  run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
}

// Turned in its sleeve a guide has a line that is known, and an end that is the drawing's.
TEST(GuideCheck, Hazard6AGuideWhoseEndNobodyMeasuredIsHeldAgainstThePointToo) {
  SourceSetup spun = nominal_source();
  spun.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Measured;
  spun.pipeline.tools.tools.back().nominal.end = true;
  PhantomOperation run;
  bring_to_the_guide(run, spun);
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Due);
  EXPECT_EQ(shown(run), GuidanceState::GuideNotChecked);
}

TEST(GuideCheck, Hazard6ANominalGuideGuidesLiveOnlyAfterItsTipWasOnTheControlPoint) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Due);
  EXPECT_EQ(shown(run), GuidanceState::GuideNotChecked);
  EXPECT_EQ(run.state()->next_action, NextAction::CheckGuide);
  hold_guide(run, test::on_bone(trial(), 2) + Eigen::Vector3d(0.6, 0, 0.8));  // 1 mm off
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
  EXPECT_NEAR(run.state()->guide_check.error_mm, 1, 1e-9);
  EXPECT_EQ(run.last_text(JournalKind::GuideChecked), "its tip lies 1.0 mm from the control point");
  EXPECT_EQ(shown(run), GuidanceState::Valid);
}

// Whatever the numbers of the guide say, its tip is elsewhere: nothing guides, in the same frame, until a
// check finds it, or it is measured. One that is repeated takes its word back, either way.
TEST(GuideCheck, Hazard6AGuideWhoseTipIsElsewhereGuidesNothing) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  const Eigen::Vector3d point_mm = test::on_bone(trial(), 2);
  const Eigen::Vector3d off_mm(0, 0, TouchLimits().max_guide_error_mm + 0.1);
  hold_guide(run, point_mm + off_mm);
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Off);
  EXPECT_EQ(shown(run), GuidanceState::GuideNotChecked);
  EXPECT_FALSE(run.state()->drilled.has_evidence);
  hold_guide(run, point_mm);
  run.apply(CheckGuide{});
  ASSERT_EQ(shown(run), GuidanceState::Valid);
  hold_guide(run, point_mm + off_mm);
  ASSERT_EQ(shown(run), GuidanceState::Valid);
  run.apply(CheckGuide{});  // at the sight of a guide that moves: what was found before stands
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::TipMoves);
  EXPECT_TRUE(run.state()->touch_is_of_guide);
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
  hold_guide(run, point_mm + off_mm);
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Off);
  EXPECT_FALSE(run.state()->frame.guidance.is_valid());
  EXPECT_EQ(shown(run), GuidanceState::GuideNotChecked);
}

TEST(GuideCheck, IsRefusedWithItsReason) {
  PhantomOperation run;
  run.apply(CheckGuide{});  // nothing is asked, nothing said
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::None);
  const SourceSetup source = nominal_source();
  run.start(source);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), source)));
  for (const double dx_mm : {0.0, 4.0, -4.0}) run.touch(test::on_bone(trial(), dx_mm));
  hold_guide(run, test::on_bone(trial(), 2));
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::NoControlPoint);
  EXPECT_EQ(run.state()->next_action, NextAction::SetControlPoint);
  run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_FALSE(run.state()->touch_is_of_guide);
  run.apply(CheckGuide{});  // only the probe was in view
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::TipUnknown);
  run.operation().end_source();
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::NoSource);
  EXPECT_EQ(run.count(JournalKind::GuideChecked), 0);
}

// The place that the guide is held on is the one that this probe, seen this way, has touched: a control point
// of before tells a bumped marker, and nothing of the guide.
TEST(GuideCheck, Hazard6AControlPointOfBeforeIsNoPlaceToHoldItOn) {
  PhantomOperation run;
  run.start(nominal_source(SourceKind::Recording));
  const Eigen::Vector3d before_mm = test::on_bone(trial(), 2);
  run.touch(before_mm, TouchControlPoint{});
  const SourceSetup source = nominal_source();
  run.start(source);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), source)));
  for (const double dx_mm : {0.0, 4.0, -4.0}) run.touch(test::on_bone(trial(), dx_mm));
  hold_guide(run, before_mm);
  run.apply(CheckGuide{});
  EXPECT_EQ(run.state()->touch_refusal, TouchRefusal::NoControlPoint);
  EXPECT_EQ(run.state()->next_action, NextAction::CheckControlPoint);
  const Eigen::Vector3d now_mm = before_mm + Eigen::Vector3d(0.9, 0, 0);
  run.touch(now_mm, TouchControlPoint{});
  hold_guide(run, now_mm + Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(run.state()->next_action, NextAction::CheckGuide);
  run.apply(CheckGuide{});
  EXPECT_NEAR(run.state()->guide_check.error_mm, 1, 1e-9) << "from where it was touched now";
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
}

// A marker that was bumped is no guide that is off: with the control point that verdict goes, and while an
// alarm stands none is found.
TEST(GuideCheck, ThatItIsOffGoesWithTheControlPoint) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  hold_guide(run, test::on_bone(trial(), 2) + Eigen::Vector3d(5, 0, 0));
  run.apply(CheckGuide{});
  ASSERT_EQ(run.state()->guide_check.standing, GuideStanding::Off);
  run.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Due);
  EXPECT_EQ(run.state()->guide_check.error_mm, 0);
  PhantomOperation bumped;
  bring_to_the_guide(bumped, nominal_source());
  for (int i = 0; i < 2; ++i)
    bumped.touch(test::on_bone(trial(), 2) + Eigen::Vector3d(4, 0, 0), TouchControlPoint{});
  ASSERT_EQ(bumped.in_force().standing, Standing::Alarm);
  hold_guide(bumped, test::on_bone(trial(), 2));
  bumped.apply(CheckGuide{});
  EXPECT_EQ(bumped.state()->guide_check.standing, GuideStanding::Due);
}

// What was seen of a guide that turns out to be off is no evidence of a tunnel.
TEST(GuideCheck, AGuideThatIsOffLeavesNoEvidence) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  run.apply(TrustGuide{});
  for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i);
  ASSERT_TRUE(run.state()->drilled.has_evidence);
  hold_guide(run, test::on_bone(trial(), 2) + Eigen::Vector3d(5, 0, 0));
  run.apply(CheckGuide{});
  EXPECT_FALSE(run.state()->drilled.has_evidence);
  run.apply(TunnelDrilled{});
  EXPECT_FALSE(run.state()->drilled.tunnel);
}

// The guide on its plan, not measured, and a drill with a marker of its own that is so deep.
void show_drill(PhantomOperation& run, double depth_mm) {
  const PlannedTunnel plan = test::phantom_plan();
  pipeline::FrameResult frame = run.frame();
  frame.tools.back().world_from_tool.is_valid = true;
  frame.guidance.state = GuidanceState::Valid;
  frame.guidance.timestamp_ns = frame.timestamp_ns;
  frame.guidance.drill = guidance::drill_depth(plan.tunnel, plan.length_mm,
                                               plan.tunnel.entry_mm + depth_mm * plan.tunnel.direction,
                                               plan.tunnel.direction, 0.3);
  run.show(frame);
}

// No guide makes what is seen of a drill by its own marker wrong: that it breaks out is told whether somebody
// has held the guide on the control point yet or not.
TEST(GuideCheck, Hazard7TheDrillIsToldOfWhateverTheGuideIs) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  for (int i = 0; i < 100; ++i) show_drill(run, 28.5);
  EXPECT_EQ(run.state()->frame.guidance.state, GuidanceState::GuideNotChecked);
  ASSERT_TRUE(run.state()->frame.guidance.drill);
  EXPECT_EQ(run.state()->frame.guidance.drill->breakout, guidance::Breakout::Imminent);
  EXPECT_TRUE(run.state()->drilled.has_evidence) << "of the drill";
  hold_guide(run, test::on_bone(trial(), 2));
  run.apply(CheckGuide{});
  show_drill(run, 28.5);
  ASSERT_TRUE(run.state()->frame.guidance.is_valid());
  hold_guide(run, test::on_bone(trial(), 2) + Eigen::Vector3d(5, 0, 0));
  run.apply(CheckGuide{});
  ASSERT_EQ(run.state()->guide_check.standing, GuideStanding::Off);
  EXPECT_TRUE(run.state()->drilled.has_evidence) << "the drill was seen by no number of the guide";
  run.apply(TunnelDrilled{});
  ASSERT_TRUE(run.state()->drilled.tunnel);
  EXPECT_NEAR(run.state()->drilled.tunnel->depth_mm.value_or(0), 28.5, 1e-9);
}

// A guide that is found to be off while the drill is in the bone: that picture's warning stays.
TEST(GuideCheck, Hazard7AGuideThatIsOffTakesNoDrillAway) {
  PhantomOperation run;
  bring_to_the_guide(run, nominal_source());
  run.apply(TrustGuide{});
  hold_guide(run, test::on_bone(trial(), 2) + Eigen::Vector3d(5, 0, 0));
  pipeline::FrameResult frame = run.state()->frame;
  frame.timestamp_ns += 1;
  frame.guidance.state = GuidanceState::Valid;
  frame.guidance.drill.emplace().breakout = guidance::Breakout::Imminent;
  run.show(frame);
  run.apply(CheckGuide{});
  ASSERT_EQ(run.state()->guide_check.standing, GuideStanding::Off);
  EXPECT_EQ(run.state()->frame.guidance.state, GuidanceState::GuideNotChecked);
  EXPECT_TRUE(run.state()->frame.guidance.drill);
}

// A guide that was measured, and whatever drills nobody, is not held against anything; nor is a bone whose
// tools hold no guide.
TEST(GuideCheck, IsAskedForANominalGuideInALiveSourceAlone) {
  const auto standing_of = [](const SourceSetup& source) {
    PhantomOperation run;
    run.start(source);
    return run.state()->guide_check.standing;
  };
  EXPECT_EQ(standing_of(nominal_source()), GuideStanding::Due);
  EXPECT_EQ(standing_of(test::scripted_source()), GuideStanding::NotAsked);
  EXPECT_EQ(standing_of(nominal_source(SourceKind::Recording)), GuideStanding::NotAsked);
  EXPECT_EQ(standing_of(nominal_source(SourceKind::Simulation)), GuideStanding::NotAsked);
  SourceSetup simulated = nominal_source();
  simulated.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Simulated;
  EXPECT_EQ(standing_of(simulated), GuideStanding::Due);
  SourceSetup none = nominal_source();
  none.pipeline.tools.tools.pop_back();
  EXPECT_EQ(standing_of(none), GuideStanding::NotAsked);
}

// The same guide through the same camera, opened again, with a marker placed anew: it is still that guide.
// Another one, or the same seen through another camera, probe or medium, is held against the point again.
TEST(GuideCheck, HoldsForThisGuideSeenThisWayAlone) {
  PhantomOperation run;
  const SourceSetup source = nominal_source();
  const auto check = [&] {
    run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    hold_guide(run, test::on_bone(trial(), 2));
    run.apply(CheckGuide{});
    ASSERT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
  };
  run.start(source);
  check();
  run.start(source);
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
  EXPECT_EQ(run.last_text(JournalKind::GuideChecked),
            "before this source: its tip lay 0.0 mm from the control point");
  run.apply(MarkerPlacedAnew{});
  run.start(source);
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Checked);
  for (const int what : {0, 1, 2, 3, 4}) {
    SourceSetup other = source;
    tools::Tool& guide = other.pipeline.tools.tools.back();
    if (what == 0) guide.axis->point_mm.y() -= 1;
    if (what == 1) guide.axis->direction = Eigen::Vector3d(0, -1, 0.01).normalized();
    if (what == 2) other.pipeline.calibration.focal_px += 1;
    if (what == 3) other.pipeline.refractive_index = 1.3345;
    if (what == 4) other.pipeline.tools.tools.front().tip_mm->x() += 1;
    run.start(other);
    EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Due) << what;
    run.start(source);
    EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Due) << "it was not checked since";
    check();
  }
}

// The word of whoever starts from a command line: it is kept in the journal.
TEST(GuideCheck, TrustIsRecorded) {
  PhantomOperation run;
  const SourceSetup source = nominal_source();
  bring_to_the_guide(run, source);
  run.apply(TrustGuide{});
  EXPECT_EQ(run.state()->guide_check.standing, GuideStanding::Trusted);
  EXPECT_EQ(run.last_text(JournalKind::GuideChecked), "nominal, and nobody checked it");
  EXPECT_EQ(shown(run), GuidanceState::Valid);
  PhantomOperation measured;
  measured.start(test::scripted_source());
  measured.apply(TrustGuide{});
  EXPECT_EQ(measured.count(JournalKind::GuideChecked), 0);
}

}  // namespace
}  // namespace arthronaut::operation
