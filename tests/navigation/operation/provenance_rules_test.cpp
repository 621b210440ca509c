// A registration guides nothing but what it is of.
#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::Mismatch;
using registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

const experiments::Trial& trial() {
  static const experiments::Trial made = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return made;
}

// Another source than the one that the registration was found with, and what comes of it.
struct Change {
  std::string name;
  void (*change)(SourceSetup& source);
  Mismatch mismatch;
  bool can_be_confirmed;
};
void PrintTo(const Change& change, std::ostream* out) { *out << change.name; }

class RegistrationIsVoid : public ::testing::TestWithParam<Change> {};

// In the frame in which the source changes, and it comes back by one touch on the bone where a touch can
// show that, else never; a touch off the bone shows nothing.
TEST_P(RegistrationIsVoid, InTheSameFrameUntilATouchMayConfirmIt) {
  PhantomOperation run;
  const SourceSetup before = test::scripted_source();
  run.start(before);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), before)));
  ASSERT_EQ(run.in_force().standing, Standing::Stands);
  SourceSetup after = before;
  GetParam().change(after);
  run.start(after);
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  EXPECT_FALSE(run.in_force().registration->reliable);
  EXPECT_FALSE(run.in_force().registration->reasons.empty());
  ASSERT_TRUE(run.in_force().mismatch);
  EXPECT_EQ(*run.in_force().mismatch, GetParam().mismatch);
  EXPECT_EQ(run.in_force().can_be_confirmed, GetParam().can_be_confirmed);
  EXPECT_EQ(run.count(JournalKind::Void), 1);

  run.touch(test::on_bone(trial(), 0, 1.3));
  EXPECT_EQ(run.in_force().standing, Standing::Void) << "it missed the bone";
  for (int i = 0; i < 3; ++i) run.touch(test::on_bone(trial(), 4));
  const bool has_come_back = run.in_force().standing == Standing::Stands;
  EXPECT_EQ(has_come_back, GetParam().can_be_confirmed);
  EXPECT_EQ(run.in_force().registration->reliable, GetParam().can_be_confirmed);
  EXPECT_EQ(run.count(JournalKind::Confirmed), GetParam().can_be_confirmed ? 1 : 0);
}

// Three touches verified it with the camera of before. With another one a touch brings it back, unverified.
TEST(RegistrationIsVoid, OneTouchConfirmsAndDoesNotVerify) {
  PhantomOperation run;
  SourceSetup source = test::scripted_source();
  run.start(source);
  run.apply(test::true_registration(trial(), run.operation().now()));
  for (const double dx_mm : {0.0, 4.0, 8.0}) run.touch(test::on_bone(trial(), dx_mm));
  ASSERT_EQ(run.state()->verification, Verification::ByTouches);
  source.pipeline.calibration.focal_px += 0.5;
  run.start(source);
  run.touch(test::on_bone(trial(), 4));
  EXPECT_EQ(run.in_force().standing, Standing::Stands);
  EXPECT_EQ(run.state()->verification, Verification::NotYet);
  for (const double dx_mm : {0.0, 8.0}) run.touch(test::on_bone(trial(), dx_mm));
  EXPECT_EQ(run.state()->verification, Verification::ByTouches) << "three places, all with this camera";
}

// A simulation in between takes the touches with it: what they verified does not come back without them.
TEST(RegistrationIsVoid, Hazard1ASimulationInBetweenLeavesNothingVerified) {
  for (const SourceKind real : {SourceKind::Live, SourceKind::Recording}) {
    PhantomOperation run;
    run.start(test::scripted_source(real));
    run.apply(test::true_registration(trial(), run.operation().now()));
    run.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    for (const double dx_mm : {0.0, 4.0, 8.0}) run.touch(test::on_bone(trial(), dx_mm));
    ASSERT_EQ(run.state()->verification, Verification::ByTouches);
    run.start(test::scripted_source(SourceKind::Simulation));
    EXPECT_EQ(run.count(JournalKind::VerificationLost), 1);
    run.start(test::scripted_source(real));
    ASSERT_EQ(run.in_force().standing, Standing::Stands);
    EXPECT_EQ(run.state()->registration->touches.count(), 0U);
    EXPECT_EQ(run.state()->verification, Verification::NotYet);
    for (const RegistrationEntry& entry : *run.state()->registration->history)
      EXPECT_FALSE(entry.is_verified);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Changes, RegistrationIsVoid,
    ::testing::Values(Change{"Camera", [](SourceSetup& s) { s.pipeline.calibration.focal_px += 0.5; },
                             Mismatch::Camera, true},
                      Change{"Tools", [](SourceSetup& s) { s.pipeline.tools.tools[0].tip_mm->x() += 0.1; },
                             Mismatch::Tools, true},
                      Change{"Medium", [](SourceSetup& s) { s.pipeline.refractive_index = 1.3345; },
                             Mismatch::Medium, true},
                      Change{"RecordingForLive", [](SourceSetup& s) { s.kind = SourceKind::Recording; },
                             Mismatch::SourceKind, true},
                      Change{"SimulationForLive", [](SourceSetup& s) { s.kind = SourceKind::Simulation; },
                             Mismatch::SourceKind, false},
                      Change{"Marker",
                             [](SourceSetup& s) { s.pipeline.tools.world_markers[0].marker_id = 7; },
                             Mismatch::WorldMarker, false}),
    [](const auto& tested) { return tested.param.name; });

// What is given from elsewhere is judged by what it says it is of.
TEST(GivenRegistration, OfAnotherMeshOrBoneIsVoidForGood) {
  for (const bool is_other_mesh : {true, false}) {
    PhantomOperation run;
    const SourceSetup source = test::scripted_source();
    run.start(source);
    registration::Provenance of = provenance_of(run.operation().setup(), source);
    if (is_other_mesh)
      of.mesh_sha256 = "another";
    else
      of.bone = bones::BoneKind::Tibia;
    run.apply(test::true_registration(trial(), of));
    EXPECT_EQ(run.in_force().standing, Standing::Void);
    EXPECT_EQ(*run.in_force().mismatch, is_other_mesh ? Mismatch::Mesh : Mismatch::Bone);
    for (int i = 0; i < 3; ++i) run.touch(test::on_bone(trial(), 0));
    EXPECT_EQ(run.in_force().standing, Standing::Void);
    EXPECT_EQ(run.state()->next_action, NextAction::RegisterAnew);
  }
}

// From before a crash: nobody saw the marker meanwhile, so one touch has to show that it sits where it sat.
TEST(GivenRegistration, AResumedOneIsVoidUntilOneTouch) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.start(source);
  GiveRegistration give = test::true_registration(trial(), provenance_of(run.operation().setup(), source));
  give.is_resumed = true;
  run.apply(give);
  EXPECT_EQ(run.in_force().standing, Standing::Void);
  EXPECT_EQ(*run.in_force().mismatch, Mismatch::Placement);
  run.apply(Draw{false});
  EXPECT_EQ(run.state()->next_action, NextAction::ConfirmByTouch);
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.in_force().standing, Standing::Stands);
}

// The marker was placed anew: what was found before holds no more, and cannot be chosen again.
TEST(GivenRegistration, AMarkerPlacedAnewEndsItForGood) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.start(source);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), source)));
  run.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run.in_force().standing, Standing::None);
  EXPECT_EQ(run.in_force().registration, nullptr);
  const auto told = std::find_if(run.journal.rbegin(), run.journal.rend(), [](const JournalEntry& entry) {
    return entry.kind == JournalKind::RegistrationInForce;
  });
  ASSERT_NE(told, run.journal.rend());
  EXPECT_FALSE(told->registration->has_pose) << "the record must not end with what was found before";
  EXPECT_FALSE(told->registration->reliable);
  run.apply(ChooseRegistration{0});
  run.touch(test::on_bone(trial(), 0));
  EXPECT_EQ(run.in_force().standing, Standing::None);
}

// Strokes of another source are set aside and counted, never mixed with new ones; the same source again goes
// on with them.
TEST(StrokesOfAnotherSource, AreSetAsideNeverMixed) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.start(source);
  run.draw({trial().curves.begin(), trial().curves.begin() + 60});
  run.start(source);
  EXPECT_EQ(run.operation().points().size(), 60U) << "the same camera went on";
  SourceSetup other = source;
  other.pipeline.calibration.focal_px += 0.5;
  run.start(other);
  EXPECT_TRUE(run.operation().points().empty());
  EXPECT_EQ(run.state()->registration->set_aside_count, 60U);
  run.draw({trial().curves.begin() + 100, trial().curves.begin() + 110});
  EXPECT_EQ(run.operation().points().size(), 10U);
}

// A source that cannot be started leaves the one before it as it was.
TEST(StartSource, OneThatBreaksItsContractChangesNothing) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source();
  run.start(source);
  run.apply(test::true_registration(trial(), provenance_of(run.operation().setup(), source)));
  run.show(run.frame());
  const std::uint64_t before = digest_of_decisions(*run.state());
  SourceSetup broken = test::scripted_source(SourceKind::Simulation);
  broken.pipeline.tools.world_markers.clear();
  EXPECT_ANY_THROW(run.operation().start_source(broken));
  EXPECT_EQ(digest_of_decisions(*run.state()), before);
  EXPECT_EQ(run.state()->source->kind, SourceKind::Live);
}

}  // namespace
}  // namespace arthronaut::operation
