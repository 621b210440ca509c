// What the records of an operation that was left in the middle say of its last state.
#include "navigation/recording/resumable.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "navigation/recording/declined_resume.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_check.h"
#include "navigation/sources/exercise_source.h"
#include "tests/navigation/theatre/resumable_fixture.h"

namespace arthronaut::recording {
namespace {

// Hazard 40: an exercise is never gone on with, and hides no operation that was left before it.
TEST_F(ResumableTest, Hazard40AnExerciseIsPassedOver) {
  const SourceSetup source = test::scripted_source(SourceKind::Simulation);
  PhantomOperation exercise;
  source_name_ = sources::kExerciseSource;
  operate(exercise, source);
  end(exercise);
  EXPECT_FALSE(found());
  continues_.clear();
  source_name_ = "script";
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  end(run);
  const std::string left = std::exchange(continues_, "");
  source_name_ = sources::kExerciseSource;
  PhantomOperation again;
  operate(again, source);
  end(again);
  ASSERT_TRUE(found());
  EXPECT_EQ(found()->operation.session, left);
}

// Of one that was cut off the database is put in order by whoever reads it: it is no younger for that.
TEST_F(ResumableTest, IsAsOldAsWhatWasRecordedWheneverItWasReadLast) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  end(run);
  const std::filesystem::path session = cases::session_folders(folder_.path()).back();
  const auto then = std::filesystem::file_time_type::clock::now() - std::chrono::hours(13);
  std::filesystem::last_write_time(session / "chain.csv", then);
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_GT(std::chrono::system_clock::now() - left->last_written, std::chrono::hours(12));
  EXPECT_EQ(left->folder, session);
}

// What was declined says so, until that is taken back; a newer session of the bone decides in its place.
TEST_F(ResumableTest, WhatWasDeclinedStaysDeclined) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  end(run);
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_FALSE(left->was_declined);
  EXPECT_FALSE(can_be_taken_back(folder_.path(), left->folder));
  decline_resume(left->folder);
  EXPECT_TRUE(found()->was_declined);
  EXPECT_TRUE(can_be_taken_back(folder_.path(), left->folder));
  // A camera that gave no picture leaves a record that decides nothing.
  {
    SessionHeader empty;
    empty.bone = left->header.bone;
    empty.source_kind = sources::SourceKind::Live;
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    SessionRecorder(cases::create_session_folder(folder_.path()), empty, options).finish();
  }
  ASSERT_TRUE(found());
  EXPECT_TRUE(can_be_taken_back(folder_.path(), left->folder));
  continues_.clear();
  PhantomOperation afresh;
  operate(afresh, source);
  end(afresh);
  EXPECT_FALSE(found()->was_declined);
  EXPECT_FALSE(can_be_taken_back(folder_.path(), left->folder));
  take_back_declined_resume(left->folder);
  EXPECT_FALSE(is_resume_declined(left->folder));
}

// A tunnel that is drilled by word alone ends no operation, and is not forgotten: when it was said is told,
// by the clock on the wall; until it is taken back, or its poses are recorded.
TEST_F(ResumableTest, WhatIsDrilledByWordAloneIsTold) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  const auto began = std::chrono::system_clock::now();
  operate(run, source);
  for (int i = 0; i < 600; ++i) run.show(run.frame());
  const std::int64_t said_ns = run.frame().timestamp_ns;
  run.apply(TunnelDrilled{});
  for (int i = 0; i < 100; ++i) run.show(run.frame());
  end(run);
  const auto left = found();
  ASSERT_TRUE(left);
  ASSERT_EQ(left->said_drilled.size(), 1U);
  EXPECT_EQ(left->said_drilled.front().tunnel, "femur");
  const std::chrono::duration<double> after_begin = left->said_drilled.front().when - began;
  const std::int64_t passed_ns = said_ns - RecordedSession(left->folder).frames().front().timestamp_ns;
  ASSERT_GT(passed_ns, 4'000'000'000) << "on the pictures' clock, which is quicker here than the wall's";
  EXPECT_NEAR(after_begin.count(), static_cast<double>(passed_ns) * 1e-9, 2)
      << "a record tells whole seconds";
  begin(run, source);  // it goes on
  run.show(run.frame());
  EXPECT_EQ(found()->said_drilled.size(), 1U);
  run.apply(TakeBackDrilled{});
  end(run);
  EXPECT_TRUE(found()->said_drilled.empty());
}

// While it goes on it was not cut off.
TEST_F(ResumableTest, OneThatIsBeingRecordedIsSaidToBe) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  std::optional<Resumable> left;  // the record is committed twice a second
  for (int i = 0; i < 100 && !left; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    left = found();
  }
  ASSERT_TRUE(left);
  EXPECT_FALSE(left->was_finished);
  EXPECT_TRUE(left->is_being_recorded);
  end(run);
  EXPECT_TRUE(found()->was_finished);
  EXPECT_FALSE(found()->is_being_recorded);
}

// A program that was killed lets its locks go when the last of its memory is gone: it records nothing any
// more.
TEST_F(ResumableTest, OneWhoseProgramIsDyingIsSaidToBeCutOff) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  for (int i = 0; i < 100 && !found(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const test::TemporaryFolder copies;  // of a record that nobody finishes
  const auto killed = copies / "Killed.arthro";
  std::filesystem::copy(folder_.path(), killed, std::filesystem::copy_options::recursive);
  end(run);
  std::thread dying(
      [lock = std::make_unique<RecordingLock>(cases::session_folders(killed).back())]() mutable {
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        lock.reset();
      });
  const auto left =
      find_resumable(killed, bones::BoneKind::Femur, "the phantom's", {bones::BoneKind::Femur}).left;
  dying.join();
  ASSERT_TRUE(left);
  EXPECT_FALSE(left->was_finished);
  EXPECT_FALSE(left->is_being_recorded);
}

// To the last bit: what is brought back is what there was.
TEST_F(ResumableTest, Hazard12IsTheLastStateOfTheOperation) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  PlannedTunnel edited = test::phantom_plan();
  edited.length_mm += 1;
  run.apply(OfferPlan{edited});
  run.apply(TakePlanOver{});
  run.apply(ReadDepthStop{21.5});
  const OperationStatePtr before = run.state();
  end(run);
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_EQ(left->refusal, "");
  EXPECT_EQ(left->operation.session, continues_);
  EXPECT_EQ(left->header.source_kind, sources::SourceKind::Live);
  EXPECT_EQ(left->operation.plan, edited);
  EXPECT_EQ(left->operation.depth_stop_mm, 21.5);
  ASSERT_TRUE(left->operation.registration);
  EXPECT_EQ(left->operation.registration->marker_from_bone.translation_mm,
            trial_.marker_from_bone.translation_mm);
  EXPECT_EQ(left->operation.registration->marker_from_bone.rotation.coeffs(),
            trial_.marker_from_bone.rotation.coeffs());
  EXPECT_FALSE(arthronaut::registration::mismatch_of(left->operation.registration_of,
                                                     provenance_of(run.operation().setup(), source)));
  EXPECT_EQ(left->operation.touches_mm, before->registration->touches.places_mm());
  EXPECT_EQ(left->operation.touches_mm.size(), 2U);
  EXPECT_EQ(*left->operation.control_point_mm, *before->registration->touches.control_point_mm());
  ASSERT_EQ(left->operation.drawn.size(), before->registration->drawn->size());
  for (std::size_t i = 0; i < left->operation.drawn.size(); ++i)
    EXPECT_EQ(left->operation.drawn[i].position_mm, (*before->registration->drawn)[i].position_mm);
  EXPECT_GT(left->operation.stroke_count, 0);
  EXPECT_DOUBLE_EQ(left->drawn_length_mm, strokes::length_mm(run.operation().strokes_in_use()));
}

// After an alarm nothing that rests on the marker is brought back, neither what guided last nor what an older
// session found; the screen can say why.
TEST_F(ResumableTest, Hazard16AfterAnAlarmNothingThatRestsOnTheMarkerComesBack) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  begin(run, source);
  for (int i = 0; i < 2; ++i)
    run.touch(test::on_bone(trial_, 2) + Eigen::Vector3d(0, 0, 3), TouchControlPoint{});
  ASSERT_EQ(run.in_force().standing, Standing::Alarm);
  for (const bool is_over_by_another_source : {false, true}) {
    if (is_over_by_another_source) {
      // Void takes the alarm's place; that is no reason to believe in the marker.
      SourceSetup other = source;
      other.pipeline.calibration.focal_px += 1;
      begin(run, other);
      run.show(run.frame());
      ASSERT_EQ(run.in_force().standing, Standing::Void);
    }
    end(run);
    const auto left = found();
    ASSERT_TRUE(left);
    EXPECT_FALSE(left->operation.registration);
    EXPECT_EQ(left->refusal.find("it was in doubt at the end: The control point has moved by 3.0 mm"), 0U)
        << left->refusal;
    EXPECT_TRUE(left->operation.touches_mm.empty());
    EXPECT_FALSE(left->operation.control_point_mm);
    EXPECT_TRUE(left->operation.drawn.empty());
    EXPECT_EQ(left->operation.plan, test::phantom_plan());
  }
}

// An alarm that was answered is over.
TEST_F(ResumableTest, AnAlarmThatWasAnsweredIsNoReason) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  for (int i = 0; i < 2; ++i)
    run.touch(test::on_bone(trial_, 2) + Eigen::Vector3d(0, 0, 3), TouchControlPoint{});
  run.apply(ForgetTouches{});
  ASSERT_EQ(run.in_force().standing, Standing::Stands);
  end(run);
  EXPECT_EQ(found()->refusal, "");
  EXPECT_TRUE(found()->operation.registration);
}

// What was void at the end comes back with what it is of, which decides again; a marker that was placed anew
// leaves none.
TEST_F(ResumableTest, WhatWasVoidComesBackAsOfWhatItWas) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  SourceSetup other = source;
  other.pipeline.calibration.focal_px += 1;
  begin(run, other);
  run.show(run.frame());
  ASSERT_EQ(run.in_force().standing, Standing::Void);
  const auto camera = provenance_of(run.operation().setup(), source).camera;
  end(run);
  ASSERT_TRUE(found()->operation.registration);
  EXPECT_EQ(found()->operation.registration_of.camera, camera);
  EXPECT_NE(found()->operation.of.camera, camera);

  begin(run, source);
  run.show(run.frame());
  run.apply(MarkerPlacedAnew{});
  run.apply(ReadDepthStop{4});
  end(run);
  ASSERT_TRUE(found());
  EXPECT_FALSE(found()->operation.registration);
  EXPECT_EQ(found()->refusal, "nothing was registered");
  EXPECT_TRUE(found()->operation.touches_mm.empty());
  EXPECT_EQ(found()->operation.stroke_count, 0);
}

// Over the sessions of one operation: strokes of both; and where the probe hovers while a registration
// stands, nothing is drawn.
TEST_F(ResumableTest, GoesBackOverTheSessionsOfTheOperation) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  const std::size_t drawn = run.operation().points().size();
  begin(run, source);
  ASSERT_FALSE(run.state()->draws);
  run.draw(part(200, 260));
  EXPECT_EQ(run.operation().points().size(), drawn);
  run.apply(Draw{true});
  run.draw(part(300, 400));
  const double length_mm = strokes::length_mm(run.operation().strokes_in_use());
  end(run);
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_DOUBLE_EQ(left->drawn_length_mm, length_mm);
  EXPECT_EQ(left->operation.touches_mm.size(), 2U);
  EXPECT_TRUE(left->operation.registration);
}

// One that was resumed and cut off again before a touch comes back a second time, though its first record is
// gone: the second holds all of it.
TEST_F(ResumableTest, ComesBackASecondTime) {
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  {
    PhantomOperation run;
    operate(run, source);
    end(run);
  }
  const auto first = found();
  ASSERT_TRUE(first);
  {
    PhantomOperation run;
    resume(run, first->operation);
    begin(run, source);
    EXPECT_EQ(run.in_force().standing, Standing::Void);
    run.draw(part(0, 100));  // the probe hovers: a touch is waited for, and nothing is drawn
    EXPECT_TRUE(run.operation().points().empty());
    end(run);
  }
  std::filesystem::remove_all(folder_ / "sessions" / first->operation.session);
  const auto second = found();
  ASSERT_TRUE(second);
  EXPECT_NE(second->operation.session, first->operation.session);
  EXPECT_EQ(second->header.continues, first->operation.session);
  EXPECT_EQ(second->refusal, "");
  ASSERT_TRUE(second->operation.registration);
  EXPECT_EQ(second->operation.registration->marker_from_bone.translation_mm,
            first->operation.registration->marker_from_bone.translation_mm);
  EXPECT_EQ(second->operation.touches_mm, first->operation.touches_mm);
  EXPECT_EQ(*second->operation.control_point_mm, *first->operation.control_point_mm);
  EXPECT_EQ(second->operation.drawn.size(), first->operation.drawn.size());
  EXPECT_EQ(second->operation.stroke_count, first->operation.stroke_count);
}

// What is decided when the source has ended already is as much a part of the record: a registration found
// then comes back, and one whose marker was placed anew then does not.
TEST_F(ResumableTest, Hazard16WhatWasDecidedAfterTheEndCounts) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  begin(run, source);
  run.apply(Draw{true});
  run.draw(trial_.curves);
  const bool was_found_while_drawing = run.in_force().standing != Standing::None;
  end(run);
  run.on_journal = [this](const auto& entries) {
    recording::append_entries(cases::session_folders(folder_.path()).back(), entries);
  };
  if (!was_found_while_drawing) {
    EXPECT_FALSE(found()->operation.registration);
  }
  run.apply(RegisterStrokes{});
  ASSERT_TRUE(run.in_force().registration);
  ASSERT_TRUE(run.in_force().registration->reliable);
  const auto with = found();
  ASSERT_TRUE(with && with->operation.registration);
  EXPECT_EQ(with->operation.registration->marker_from_bone.translation_mm,
            run.in_force().registration->marker_from_bone.translation_mm);
  run.apply(MarkerPlacedAnew{});
  const auto without = found();
  EXPECT_FALSE(without && without->operation.registration);
}

// Killed between the command and what it takes away: the registration of before does not come back.
TEST_F(ResumableTest, Hazard16AMarkerPlacedAnewInTheLastMomentCounts) {
  PhantomOperation run;
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  operate(run, source);
  end(run);
  ASSERT_TRUE(found() && found()->operation.registration);
  recording::append_event(
      cases::session_folders(folder_.path()).back(),
      {.kind = std::string(recording::kCommandEvent), .text = operation::to_text(MarkerPlacedAnew{})});
  const auto left = found();
  EXPECT_FALSE(left && left->operation.registration);
}

}  // namespace
}  // namespace arthronaut::recording
