// What the records of an operation that was left in the middle say of its last state.
#include "navigation/recording/resumable.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_check.h"
#include "navigation/sources/exercise_source.h"
#include "planning/cases/case.h"
#include "tests/navigation/operation/phantom_operation.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

using namespace operation;
using arthronaut::registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

class ResumableTest : public ::testing::Test {
 protected:
  // A source of the operation from here on, in a record of its own.
  void begin(PhantomOperation& run, const SourceSetup& source) {
    end(run);
    const std::filesystem::path folder = cases::create_session_folder(folder_.path());
    sources::SourceInfo info;
    info.name = source_name_;
    record_ = std::make_unique<OperationRecord>(folder, run.operation().setup(), source, info, continues_);
    continues_ = folder.filename().string();
    if (!early_.empty()) record_->add(std::exchange(early_, {}));
    run.on_journal = [this](const auto& entries) { record_->add(entries); };
    run.on_frame = [this](const OperationState& state) { record_->add_frame(nullptr, state, false); };
    run.start(source);
  }
  void end(PhantomOperation& run) {
    if (record_ == nullptr) return;
    run.operation().end_source();
    record_->add(run.operation().take_journal());
    record_->finish(run.operation().strokes_in_use());
    record_.reset();
    run.on_frame = {};
  }
  // Another program: what is given before its first source goes to the record of that one.
  void resume(PhantomOperation& run, const ResumeOperation& left) {
    run.on_journal = [this](const auto& entries) {
      early_.insert(early_.end(), entries.begin(), entries.end());
    };
    run.apply(left);
    continues_ = left.session;
  }
  [[nodiscard]] std::optional<Resumable> found(const std::string& mesh = "the phantom's") const {
    return find_resumable(folder_.path(), bones::BoneKind::Femur, mesh, planned_);
  }
  [[nodiscard]] GiveRegistration given(PhantomOperation& run, const SourceSetup& source) const {
    return test::true_registration(trial_, provenance_of(run.operation().setup(), source));
  }
  [[nodiscard]] strokes::Curves part(std::ptrdiff_t from, std::ptrdiff_t to) const {
    return {trial_.curves.begin() + from, trial_.curves.begin() + to};
  }
  // Strokes, a registration, two touches and a control point.
  void operate(PhantomOperation& run, const SourceSetup& source) {
    begin(run, source);
    run.draw(part(0, 150));
    run.apply(Draw{false});
    run.apply(given(run, source));
    run.touch(test::on_bone(trial_, 0));
    run.touch(test::on_bone(trial_, 5));
    run.touch(test::on_bone(trial_, 2), TouchControlPoint{});
  }

  const test::TemporaryFolder folder_;
  experiments::Trial trial_ = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  std::unique_ptr<OperationRecord> record_;
  std::vector<JournalEntry> early_;
  std::string continues_, source_name_ = "script";
  std::vector<tunnels::TunnelKey> planned_{bones::BoneKind::Femur};
};

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
  EXPECT_EQ(left->header.source_kind, "live");
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

TEST_F(ResumableTest, IsNoneWhereNothingWasLeftInTheMiddle) {
  EXPECT_FALSE(found()) << "no session";
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  {
    PhantomOperation run;
    begin(run, source);
    run.apply(Draw{false});
    run.show(run.frame());
    end(run);
    EXPECT_FALSE(found()) << "it had come to nothing";
  }
  {
    PhantomOperation run;
    operate(run, source);
    end(run);
  }
  EXPECT_TRUE(found());
  EXPECT_FALSE(found("another")) << "another mesh";
  EXPECT_FALSE(find_resumable(folder_.path(), bones::BoneKind::Tibia, "", planned_)) << "another bone";
  {
    OperationSetup setup = test::phantom_setup();
    setup.registers_after_mm = 40;
    PhantomOperation run(setup);
    operate(run, source);
    end(run);
    EXPECT_FALSE(found()) << "nobody was at the pedal";
  }
  {
    PhantomOperation run;
    operate(run, source);
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
    end(run);
    EXPECT_FALSE(found()) << "it had come to its end";
  }
  {
    PhantomOperation run;
    operate(run, source);
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    run.apply(TakeBackDrilled{});
    end(run);
    EXPECT_TRUE(found()) << "it was not drilled after all";
    const std::filesystem::path session = cases::session_folders(folder_.path()).back();
    EXPECT_TRUE(std::filesystem::exists(session / "achieved.json")) << "as a part of the record";
    EXPECT_TRUE(operation::achieved_files(session).empty()) << "nothing tells of it as achieved";
    EXPECT_EQ(check_session(session).outcome, SessionCheck::Outcome::Unbroken);
  }
}

// The first of two bundles' tunnels is drilled: the operation is not at its end while the other one is
// planned.
TEST_F(ResumableTest, GoesOnWhileTheOtherBundlesTunnelIsNotDrilled) {
  const tunnels::TunnelKey am{bones::BoneKind::Femur, norms::Bundle::Anteromedial};
  const tunnels::TunnelKey pl{bones::BoneKind::Femur, norms::Bundle::Posterolateral};
  planned_ = {am, pl};
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  const auto drill = [&](PhantomOperation& run) {
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  };
  OperationSetup setup = test::phantom_setup();
  setup.plan->tunnel.bundle = am.bundle;
  PhantomOperation run(setup);
  operate(run, source);
  drill(run);
  end(run);
  const auto left = found();
  ASSERT_TRUE(left) << "PL is not drilled";
  EXPECT_EQ(left->drilled, std::vector<tunnels::TunnelKey>{am});
  EXPECT_TRUE(left->operation.registration);
  planned_ = {am};
  EXPECT_FALSE(found()) << "nothing else is planned";
  planned_ = {am, pl};
  PlannedTunnel other = *setup.plan;
  other.tunnel.bundle = pl.bundle;
  run.on_journal = [this](const auto& entries) {
    early_.insert(early_.end(), entries.begin(), entries.end());
  };
  run.apply(OfferPlan{other});  // in the next record, which goes on from this one
  begin(run, source);
  drill(run);
  end(run);
  EXPECT_FALSE(found()) << "both are drilled";
}

// A newer session that cannot be read is passed over, and that is told.
TEST_F(ResumableTest, ABrokenSessionIsToldNotSilentlyPassedOver) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  end(run);
  const std::filesystem::path broken = cases::create_session_folder(folder_.path());
  std::ofstream(broken / "session.json") << "{";
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_EQ(left->operation.session, continues_);
  ASSERT_EQ(left->passed_over.size(), 1U);
  EXPECT_NE(left->passed_over.front().find(broken.filename().string()), std::string::npos);
}

}  // namespace
}  // namespace arthronaut::recording
