// What an operation forgets when it is known that the medium was wrong for a while.
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/navigation/operation/operation_rules.h"

namespace arthronaut::operation {
namespace {

class WrongMedium : public test::OperationRules {
 protected:
  // Another stretch of the strokes each time.
  void draw(int points = 60) {
    run_.apply(Draw{true});
    run_.draw({trial_.curves.begin() + next_, trial_.curves.begin() + next_ + points});
    next_ += points;
    run_.apply(Draw{false});
  }
  [[nodiscard]] SeenMedium sure_until_now() { return {run_.operation().frame().timestamp_ns}; }
  void tell(const SeenMedium& seen) {
    run_.operation().tell_medium_wrong(seen);
    run_.apply(Draw{false});  // any command: the journal is taken
  }
  std::ptrdiff_t next_ = 0;
};

// It takes seconds until the markers have told it; what was measured meanwhile is gone, and what was measured
// before stays.
TEST_F(WrongMedium, Hazard27WhatWasMeasuredThroughItIsGone) {
  give();
  draw();
  run_.touch(on_bone(6), TouchControlPoint{});
  run_.touch(on_bone(0));
  const SeenMedium seen = sure_until_now();
  const std::size_t points = run_.operation().points().size();
  draw();
  run_.touch(on_bone(6) + Eigen::Vector3d(0, 0, 3), TouchControlPoint{});
  for (const double dx_mm : {4.0, -4.0}) run_.touch(on_bone(dx_mm));
  ASSERT_EQ(run_.state()->verification, Verification::ByTouches);
  ASSERT_TRUE(run_.state()->registration->touches.control_point_lies_off());
  ASSERT_GT(run_.operation().points().size(), points);
  tell(seen);
  EXPECT_EQ(run_.count(JournalKind::MediumWrong), 1);
  EXPECT_EQ(run_.operation().points().size(), points);
  const Touches& touches = run_.state()->registration->touches;
  EXPECT_EQ(touches.count(), 1U);
  EXPECT_TRUE(touches.has_control_point());
  EXPECT_FALSE(touches.control_point_lies_off()) << "that was no touch of it";
  EXPECT_EQ(run_.in_force().standing, Standing::Stands) << "it was given before";
  EXPECT_EQ(run_.state()->verification, Verification::NotYet);
  EXPECT_EQ(run_.state()->control_point_due, ControlPointDue::CheckAfterLoss)
      << "what it was touched for is not answered";
}

// It has never fitted: nothing of this source was sure, and what an earlier one measured stays.
TEST_F(WrongMedium, Hazard27OfASourceWhoseMediumNeverFittedNothingIsLeft) {
  draw();
  run_.touch(on_bone(6), TouchControlPoint{});
  const std::size_t points = run_.operation().points().size();
  run_.operation().end_source();
  run_.start(test::scripted_source());
  draw();
  run_.touch(on_bone(6), TouchControlPoint{});
  run_.touch(on_bone(0));
  tell({});
  EXPECT_EQ(run_.operation().points().size(), points);
  EXPECT_EQ(run_.state()->registration->touches.count(), 0U);
  EXPECT_TRUE(run_.state()->registration->touches.has_control_point());
}

// A registration rests on its strokes: the one of before them is in force again, or none.
TEST_F(WrongMedium, Hazard27ARegistrationThatWasFoundThroughItGuidesNoMore) {
  for (const bool had_one : {true, false}) {
    run_.apply(MarkerPlacedAnew{});
    if (had_one) give();
    const auto before = run_.in_force().registration;
    const SeenMedium seen = sure_until_now();
    run_.apply(Draw{true});
    run_.draw(trial_.curves);
    run_.apply(RegisterStrokes{});
    ASSERT_EQ(run_.in_force().standing, Standing::Stands);
    ASSERT_NE(run_.in_force().registration, before);
    tell(seen);
    EXPECT_EQ(run_.in_force().standing, had_one ? Standing::Stands : Standing::None);
    EXPECT_EQ(run_.in_force().registration, before);
    const std::size_t newest = run_.state()->registration->history->size() - 1;
    run_.apply(ChooseRegistration{newest});
    EXPECT_EQ(run_.in_force().registration, before) << "it can't be taken again";
  }
}

// One touch confirms what is void, and one through the wrong medium does not.
TEST_F(WrongMedium, Hazard27ATouchThroughItConfirmsNothing) {
  GiveRegistration resumed = test::true_registration(trial_, run_.operation().now());
  resumed.is_resumed = true;
  run_.apply(resumed);
  const SeenMedium seen = sure_until_now();
  run_.touch(on_bone(0));
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  tell(seen);
  EXPECT_EQ(run_.in_force().standing, Standing::Void);
  EXPECT_TRUE(run_.in_force().can_be_confirmed);
  run_.touch(on_bone(0));
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

TEST(SeenMedium, ComesBackFromItsText) {
  for (const std::int64_t last_sure_ns : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{4'000'000'001}})
    EXPECT_EQ(seen_medium_from_text(to_text(SeenMedium{last_sure_ns}), "events").last_sure_ns, last_sure_ns);
  for (const char* bad : {"", "sure", "last sure at ", "last sure at 5", "last sure at -5 ns", "never"})
    EXPECT_THROW((void)seen_medium_from_text(bad, "events"), InvalidInput) << bad;
}

}  // namespace
}  // namespace arthronaut::operation
