// What an operation makes of a bone that the picture shows elsewhere. What the picture shows is told by word
// here, as in a run from a record; contour_check_test.cpp has the pictures.
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using guidance::GuidanceState;
using registration::phantom_bone;
using test::PhantomOperation;

const experiments::Trial& trial() {
  static const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return trial;
}

// Registered and with a control point.
class BoneMoved : public ::testing::Test {
 protected:
  void SetUp() override {
    const SourceSetup source = test::scripted_source();
    run_.start(source);
    run_.apply(test::true_registration(trial(), provenance_of(run_.operation().setup(), source)));
    run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    run_.apply(SkipVerification{});
  }
  GuidanceState shown() {
    run_.show_guide(-5);
    return run_.state()->frame.guidance.state;
  }
  void tell(double drift_mm, std::int64_t held_until_ns = SeenDrift().held_until_ns) {
    run_.operation().tell_bone_moved({drift_mm, held_until_ns});
    run_.apply(Draw{false});  // any command: the journal is taken
  }
  void tell_looks(bool otherwise, std::int64_t held_until_ns = SeenLooks().held_until_ns) {
    run_.operation().tell_bone_looks({otherwise, held_until_ns});
    run_.apply(Draw{false});
  }
  PhantomOperation run_;
};

// As a control point that has wandered: no number stands in the same frame, the reason is said, and what
// comes next is to look at the marker.
TEST_F(BoneMoved, Hazard25APictureThatShowsTheBoneElsewhereEndsGuidance) {
  ASSERT_EQ(shown(), GuidanceState::Valid);
  tell(1.1);
  EXPECT_NE(run_.state()->frame.guidance.state, GuidanceState::Valid);
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
  EXPECT_EQ(run_.in_force().registration->reasons.front(),
            "The picture shows the bone 1.1 mm from where it lay under its marker");
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckWorldMarker);
  EXPECT_EQ(run_.count(JournalKind::BoneMoved), 1);
  EXPECT_EQ(run_.count(JournalKind::Alarm), 1);
  EXPECT_NE(shown(), GuidanceState::Valid) << "and in all that follow";
  tell(1.2);
  EXPECT_EQ(run_.count(JournalKind::BoneMoved), 1) << "told once";
}

// Nobody set one, which is normal while guidance runs: one that is set now knows only where the bone lies
// since it moved, and touched again it is where it was, of course.
TEST_F(BoneMoved, AControlPointThatWasNotSetBeforeConfirmsNothing) {
  run_.apply(ForgetTouches{});
  run_.apply(SkipVerification{});
  ASSERT_EQ(shown(), GuidanceState::Valid) << "guidance without a control point";
  ASSERT_FALSE(run_.state()->registration->touches.has_control_point());
  tell(1.0);
  for (int press = 0; press < 3; ++press) {
    run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    EXPECT_EQ(run_.in_force().standing, Standing::Alarm) << press;
    EXPECT_NE(shown(), GuidanceState::Valid) << press;
    EXPECT_FALSE(run_.state()->registration->touches.has_control_point());
  }
  EXPECT_FALSE(run_.last_text(JournalKind::Note).empty()) << "and why is in the journal";
  run_.apply(MarkerPlacedAnew{});
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_TRUE(run_.state()->registration->touches.has_control_point()) << "of the marker as it sits now";
}

// A knock, then the control point is set, and a second later the picture tells: it was set on a bone that had
// moved, and agrees with itself for ever.
TEST_F(BoneMoved, Hazard25AControlPointThatWasSetSinceConfirmsNothing) {
  run_.apply(ForgetTouches{});
  run_.apply(SkipVerification{});
  shown();
  const std::int64_t held_until_ns = run_.operation().frame().timestamp_ns;
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  ASSERT_TRUE(run_.state()->registration->touches.has_control_point());
  tell(1.0, held_until_ns);
  EXPECT_FALSE(run_.state()->registration->alarm.control_point_decides);
  for (int press = 0; press < 3; ++press) {
    run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    EXPECT_EQ(run_.in_force().standing, Standing::Alarm) << press;
  }
  EXPECT_NE(run_.last_text(JournalKind::Note).find("may have moved already"), std::string::npos);
  run_.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run_.in_force().standing, Standing::None);
}

// Set while the picture still showed the bone where it lay, and touched again when it had moved: the first
// touch is what counts, and may lift it.
TEST_F(BoneMoved, AControlPointThatWasSetBeforeDecides) {
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  const std::int64_t held_until_ns = run_.operation().frame().timestamp_ns - 500'000'000;
  tell(1.0, held_until_ns);
  EXPECT_TRUE(run_.state()->registration->alarm.control_point_decides);
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

TEST(SeenDrift, IsReadAsItWasWritten) {
  const SeenDrift drift{1.1, 4'000'000'017};
  const SeenDrift read = seen_drift_from_text(to_text(drift), "journal");
  EXPECT_EQ(read.drift_mm, drift.drift_mm) << "to the last bit: replay rests on it";
  EXPECT_EQ(read.held_until_ns, drift.held_until_ns);
  EXPECT_EQ(seen_drift_from_text("1.25", "journal").held_until_ns, SeenDrift().held_until_ns)
      << "of an older version";
  for (const char* broken : {"", "far", "nan", "-1", "1.1 mm", "1.1 mm, where it lay until  ns",
                             "1.1 mm, where it lay until 5 ns and on"})
    EXPECT_THROW((void)seen_drift_from_text(broken, "journal"), InvalidInput) << broken;
}

TEST(SeenLooks, IsReadAsItWasWritten) {
  const SeenLooks read = seen_looks_from_text(to_text(SeenLooks{true, 4'000'000'017}), "journal");
  EXPECT_TRUE(read.otherwise);
  EXPECT_EQ(read.held_until_ns, 4'000'000'017);
  EXPECT_FALSE(seen_looks_from_text(to_text(SeenLooks{}), "journal").otherwise);
  const SeenLooks older = seen_looks_from_text("otherwise", "journal");
  EXPECT_TRUE(older.otherwise);
  EXPECT_EQ(older.held_until_ns, SeenLooks().held_until_ns) << "of an older version";
  for (const char* broken : {"", "other", "otherwise, as it did until  ns", "as it did until 5 ns",
                             "otherwise, as it did until 5 ns and on", "as it did "})
    EXPECT_THROW((void)seen_looks_from_text(broken, "journal"), InvalidInput) << broken;
}

// The probe on the control point outranks the picture, as far as it is finer: where it was, it lifts the
// alarm; half as far off as the picture says, it does not.
TEST_F(BoneMoved, TheControlPointLiftsItWhereItIsWhereItWas) {
  tell(1.0);
  run_.touch(test::on_bone(trial(), 2) + Eigen::Vector3d(0.6, 0, 0), TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
  run_.touch(test::on_bone(trial(), 2) + Eigen::Vector3d(0.3, 0, 0), TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_EQ(run_.last_text(JournalKind::Alarm), "") << "it is over";
  EXPECT_EQ(shown(), GuidanceState::Valid);
}

// A touch anywhere on the bone does not: by 1 mm along its surface it is on the bone all the same.
TEST_F(BoneMoved, NoOtherTouchLiftsIt) {
  tell(1.0);
  for (const double dx_mm : {0.0, 4.0, -4.0}) run_.touch(test::on_bone(trial(), dx_mm));
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
}

TEST_F(BoneMoved, TheSurgeonsWordLiftsIt) {
  tell(1.0);
  run_.apply(ForgetTouches{});
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

// Placed anew, nothing found before holds, and the alarm is over for the next registration.
TEST_F(BoneMoved, AMarkerPlacedAnewBeginsAnew) {
  tell(1.0);
  run_.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run_.in_force().standing, Standing::None);
  run_.apply(test::true_registration(trial(), run_.operation().now()));
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

// It can only raise a doubt: it verifies nothing, and says nothing where nothing stands.
TEST_F(BoneMoved, SaysNothingWithoutARegistrationThatStands) {
  run_.apply(MarkerPlacedAnew{});
  tell(1.0);
  EXPECT_EQ(run_.in_force().standing, Standing::None);
  EXPECT_EQ(run_.count(JournalKind::BoneMoved), 0);
  run_.apply(test::true_registration(trial(), run_.operation().now()));
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

// A bone that does not look as it did is no proof that it moved: the numbers stay, and the control point is
// asked for.
TEST_F(BoneMoved, Hazard25ABoneThatLooksOtherwiseAsksForTheControlPoint) {
  ASSERT_EQ(shown(), GuidanceState::Valid);
  tell_looks(true);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckLooks);
  EXPECT_EQ(run_.state()->next_action, NextAction::CheckControlPoint);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_EQ(run_.last_text(JournalKind::BoneLooks), "otherwise");
  tell_looks(true);
  EXPECT_EQ(run_.count(JournalKind::BoneLooks), 1) << "told once";
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None) << "it is where it was";
}

TEST_F(BoneMoved, AControlPointThatIsOffKeepsTheDoubtAndTheSecondOneIsTheAlarm) {
  tell_looks(true);
  run_.touch(test::on_bone(trial(), 2) + Eigen::Vector3d(3, 0, 0), TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckShift) << "that comes first";
  run_.touch(test::on_bone(trial(), 2) + Eigen::Vector3d(3, 0, 0), TouchControlPoint{});
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
}

TEST_F(BoneMoved, ADoubtIsOverWhereTheBoneLooksAsItDid) {
  tell_looks(true);
  tell_looks(false);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);
  EXPECT_EQ(run_.last_text(JournalKind::BoneLooks), "as it did");
}

// Set only now, a control point learns where the bone lies since.
TEST_F(BoneMoved, AControlPointThatIsSetInDoubtDoesNotEndIt) {
  run_.apply(ForgetTouches{});
  run_.apply(SkipVerification{});
  ASSERT_EQ(shown(), GuidanceState::Valid);
  tell_looks(true);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  for (int press = 0; press < 2; ++press) {
    run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
    EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
  }
  run_.apply(ForgetTouches{});
  EXPECT_NE(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks)
      << "the surgeon's word ends it";
}

// A knock, then the control point is set, and a second later the bone is told to look otherwise: touched
// again it is where it was, and says nothing of the knock.
TEST_F(BoneMoved, Hazard25AControlPointThatWasSetSinceEndsNoDoubt) {
  run_.apply(ForgetTouches{});
  run_.apply(SkipVerification{});
  shown();
  const std::int64_t held_until_ns = run_.operation().frame().timestamp_ns;
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  ASSERT_TRUE(run_.state()->registration->touches.has_control_point());
  tell_looks(true, held_until_ns);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
  run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
}

// Where no control point can end the doubt, touches are asked for, and no more of them than verify: the
// surgeon sees where they lie, and goes on to the tunnel in a doubt that stays said.
TEST_F(BoneMoved, ADoubtThatNothingEndsIsNoDeadEnd) {
  run_.apply(ForgetTouches{});
  run_.apply(SkipVerification{});
  ASSERT_EQ(shown(), GuidanceState::Valid);
  tell_looks(true);
  EXPECT_EQ(run_.state()->places_in_doubt, 3);
  for (const double dx_mm : {0.0, 0.0, 4.0, 0.5}) run_.touch(test::on_bone(trial(), dx_mm));
  EXPECT_EQ(run_.state()->places_in_doubt, 1) << "the same place again tells nothing more";
  EXPECT_EQ(run_.state()->next_action, NextAction::VerifyByTouch);
  run_.touch(test::on_bone(trial(), -4));
  EXPECT_EQ(run_.state()->places_in_doubt, 0);
  EXPECT_EQ(shown(), GuidanceState::Valid);
  EXPECT_EQ(run_.state()->next_action, NextAction::FollowBullseye);
  tell_looks(true);
  EXPECT_EQ(run_.count(JournalKind::BoneLooks), 1) << "it is the same doubt still";
}

// Strokes that are cleared take the touches with them: what is set after that learns where the bone lies now.
TEST_F(BoneMoved, AControlPointThatIsForgottenInDoubtDoesNotEndItAnew) {
  tell_looks(true);
  ASSERT_EQ(run_.state()->control_point_due, ControlPointDue::CheckLooks);
  run_.apply(ClearStrokes{});
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
  for (int press = 0; press < 2; ++press) run_.touch(test::on_bone(trial(), 2), TouchControlPoint{});
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CannotCheckLooks);
}

// An alarm is more than a doubt, and what comes after it begins anew.
TEST_F(BoneMoved, NoDoubtOutlivesItsRegistration) {
  tell_looks(true);
  tell(3.0);
  EXPECT_EQ(run_.in_force().standing, Standing::Alarm);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::None);
  tell_looks(true);
  EXPECT_EQ(run_.count(JournalKind::BoneLooks), 1) << "nothing stands that could be doubted";
  run_.apply(MarkerPlacedAnew{});
  run_.apply(test::true_registration(trial(), run_.operation().now()));
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::Set);
}

}  // namespace
}  // namespace arthronaut::operation
