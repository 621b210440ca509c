// An operation on drawn pictures: a ball for a bone, a marker before it. What the picture shows of the bone
// has to reach guidance by itself.
#include <gtest/gtest.h>

#include "tests/navigation/operation/ball_pictures.h"

namespace arthronaut::operation {
namespace {

using contour::ContourState;

// The lens looks about. Registered as it is seen in the first picture.
class Watched {
 public:
  explicit Watched(const OperationSetup& with = test::ball_setup()) : operation_(with) {
    operation_.start_source(test::ball_source());
    look();
    operation_.apply(test::registered_as_seen(operation_));
  }
  OperationStatePtr look(double moved_mm = 0) {
    operation_.process(pictures_.next(moved_mm));
    return operation_.state();
  }
  OperationStatePtr settle() {
    OperationStatePtr state;
    for (int i = 0; i < 60; ++i) state = look();
    return state;
  }
  Operation& operation() { return operation_; }

 private:
  Operation operation_;
  test::BallPictures pictures_;
};

Standing standing_of(const OperationStatePtr& state) { return state->registration->in_force.standing; }

TEST(WatchedBone, Hazard25ABoneThatMovesUnderItsMarkerEndsGuidanceInTheNextPicture) {
  Watched watched;
  const OperationStatePtr settled = watched.settle();
  ASSERT_TRUE(settled->frame.camera_from_world.is_valid);
  ASSERT_EQ(standing_of(settled), Standing::Stands);
  ASSERT_EQ(settled->contour.state, ContourState::Holds);
  OperationStatePtr state = settled;
  for (int i = 0; i < 45 && state->contour.state != ContourState::Drifted; ++i) state = watched.look(1);
  ASSERT_EQ(state->contour.state, ContourState::Drifted) << "told within three seconds";
  EXPECT_EQ(standing_of(watched.look(1)), Standing::Alarm);
  EXPECT_EQ(watched.operation().state()->registration->alarm.kind, TouchAlarm::Kind::SeenInPicture);
  EXPECT_EQ(watched.look(1)->contour.state, ContourState::Drifted) << "what told it stays as it was";
}

// The journal says until when the bone was seen to lie where it lay, and never a time after it moved.
TEST(WatchedBone, Hazard25SaysUntilWhenTheBoneHadNotMoved) {
  Watched watched;
  const std::int64_t moves_ns = watched.settle()->frame.timestamp_ns;
  OperationStatePtr state;
  for (int i = 0; i < 45 && (state == nullptr || state->contour.state != ContourState::Drifted); ++i)
    state = watched.look(1);
  (void)watched.operation().take_journal();
  watched.operation().apply(Draw{false});
  const std::vector<JournalEntry> journal = watched.operation().take_journal();
  ASSERT_EQ(journal.front().kind, JournalKind::BoneMoved);
  const SeenDrift told = seen_drift_from_text(journal.front().text, "the journal");
  EXPECT_EQ(told.drift_mm, state->contour.drift_mm);
  EXPECT_LE(told.held_until_ns, moves_ns);
  EXPECT_GE(told.held_until_ns, moves_ns - 2'500'000'000) << "four memories of 0.5 s, and a picture or two";
}

// Further than a drift: told as moved, or as a bone that does not look as it did, which asks for the control
// point.
TEST(WatchedBone, Hazard25AHardKnockIsNotPassedOver) {
  Watched watched;
  OperationStatePtr state = watched.settle();
  ASSERT_EQ(state->contour.state, ContourState::Holds);
  for (int i = 0; i < 45 && standing_of(state) == Standing::Stands; ++i) state = watched.look(5);
  EXPECT_TRUE(standing_of(state) == Standing::Alarm ||
              state->control_point_due >= ControlPointDue::CheckLooks);
}

// Between the picture that tells it and the next one, a press is of a bone that has moved.
TEST(WatchedBone, WhatWasSeenComesBeforeWhatIsDoneAboutIt) {
  Watched watched;
  OperationStatePtr state = watched.settle();
  for (int i = 0; i < 45 && state->contour.state != ContourState::Drifted; ++i) state = watched.look(1);
  (void)watched.operation().take_journal();
  watched.operation().apply(TouchControlPoint{});
  const std::vector<JournalEntry> journal = watched.operation().take_journal();
  ASSERT_FALSE(journal.empty());
  EXPECT_EQ(journal.front().kind, JournalKind::BoneMoved);
  EXPECT_EQ(journal.back().kind == JournalKind::BoneMoved, false) << "and then the command";
}

// Of a record, its own word alone: with the same pictures, or with some of them missing.
TEST(WatchedBone, ARunFromARecordHearsOfItAndDoesNotSeeIt) {
  OperationSetup from_record = test::ball_setup();
  from_record.hears_of_drifts = true;
  Watched watched(from_record);
  OperationStatePtr state = watched.settle();
  for (int i = 0; i < 45; ++i) state = watched.look(1);
  EXPECT_EQ(state->contour.state, ContourState::Drifted);
  EXPECT_EQ(standing_of(state), Standing::Stands);
  watched.operation().tell_bone_moved({.drift_mm = 1.346});
  EXPECT_EQ(standing_of(watched.operation().state()), Standing::Alarm);
  EXPECT_EQ(watched.operation().state()->registration->alarm.seen_drift_mm, 1.346);
}

}  // namespace
}  // namespace arthronaut::operation
