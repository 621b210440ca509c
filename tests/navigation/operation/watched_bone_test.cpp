// An operation on drawn pictures: a ball for a bone, a marker before it. What the picture shows of the bone
// has to reach guidance by itself.
#include <gtest/gtest.h>

#include "navigation/operation/operation.h"
#include "navigation/simulator/solids.h"
#include "tests/navigation/contour/rendered_bone.h"

namespace arthronaut::operation {
namespace {

using contour::ContourState;

constexpr double kMarker_mm = 6;

OperationSetup setup() {
  OperationSetup setup;
  setup.surface = std::make_shared<geometry::Surface>(contour::ball_mesh());
  return setup;
}

SourceSetup source() {
  SourceSetup source;
  source.kind = sources::SourceKind::Recording;
  source.pipeline.calibration = contour::small_camera();
  source.pipeline.refractive_index = 1.3345;
  source.pipeline.follow_lens = false;
  source.pipeline.tools.world_markers = {{bones::BoneKind::Femur, 0, kMarker_mm}};
  return source;
}

// The lens looks about. Registered as it is seen in the first picture.
class Watched {
 public:
  explicit Watched(const OperationSetup& with = setup()) : operation_(with), picture_(contour::ball_mesh()) {
    operation_.start_source(source());
    look();
    GiveRegistration give;
    give.registration.has_pose = give.registration.reliable = true;
    give.registration.reasons.clear();
    give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
    give.registration.predicted_tre_mm = 0.3;
    give.registration.marker_from_bone =
        operation_.frame().camera_from_world.target_from_source.inverse() * contour::before_the_lens();
    give.of = operation_.now();
    operation_.apply(give);
  }
  OperationStatePtr look(double moved_mm = 0) {
    const geometry::RigidTransform camera_from_bone =
        contour::before_the_lens(0.08 * std::sin(0.06 * frames_));
    const geometry::RigidTransform before_it{
        Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())), {-13, 0, 27}};
    simulator::PlateShape plate;
    plate.half_size_mm.setConstant(4);
    plate.markers = {{{0, 0}, kMarker_mm, simulator::marker_cells(0)}};
    camera::Frame& frame = picture_.picture(
        camera_from_bone * geometry::RigidTransform{Eigen::Quaterniond::Identity(), {moved_mm, 0, 0}},
        simulator::make_plate(camera_from_bone * contour::before_the_lens().inverse() * before_it, plate));
    frame.index = frames_;
    frame.timestamp_ns = ++frames_ * 1'000'000'000 / 15;
    operation_.process(frame);
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
  contour::RenderedBone picture_;
  std::int64_t frames_ = 0;
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
  OperationSetup from_record = setup();
  from_record.hears_of_drifts = true;
  Watched watched(from_record);
  OperationStatePtr state = watched.settle();
  for (int i = 0; i < 45; ++i) state = watched.look(1);
  EXPECT_EQ(state->contour.state, ContourState::Drifted);
  EXPECT_EQ(standing_of(state), Standing::Stands);
  watched.operation().tell_bone_moved(1.346);
  EXPECT_EQ(standing_of(watched.operation().state()), Standing::Alarm);
  EXPECT_EQ(watched.operation().state()->registration->alarm.seen_drift_mm, 1.346);
}

}  // namespace
}  // namespace arthronaut::operation
