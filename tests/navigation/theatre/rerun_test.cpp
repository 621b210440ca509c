// What a rerun takes from the record and what from the pictures, on a ball that moves under its marker, or
// does not.
#include "navigation/recording/rerun.h"

#include <gtest/gtest.h>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_database.h"
#include "tests/navigation/operation/ball_pictures.h"
#include "tests/navigation/operation/phantom_operation.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

using contour::ContourState;
using operation::Standing;

constexpr std::int64_t kFrames = 110, kMovesAt = 60;
constexpr std::int64_t kNever = 1'000'000;

class RerunTest : public ::testing::Test {
 protected:
  // Registered from the first frame on.
  [[nodiscard]] RecordedSession recorded(std::int64_t moves_at) const {
    const operation::OperationSetup setup = test::ball_setup();
    const std::filesystem::path session = folder_ / ("session" + std::to_string(moves_at));
    std::filesystem::create_directory(session);
    theatre::OperationRun run(setup, test::at_once(setup), [&] { return session; });
    theatre::TheatreSource source;
    source.setup = test::ball_source();
    source.open = [=] { return std::make_unique<test::BallSource>(kFrames, moves_at); };
    run.start(source);
    run.apply(test::registered_beforehand());
    while (run.step().picture != nullptr) {
    }
    run.end_source();
    return RecordedSession(session);
  }
  // The state after the last frame, by pictures in which the bone moves then.
  [[nodiscard]] static operation::OperationStatePtr run_again(const RecordedSession& session,
                                                              std::int64_t moves_at) {
    Rerun rerun(test::ball_setup(), Registrations::NotFollowed, nullptr);
    rerun.start(session);
    test::BallPictures pictures;
    operation::OperationStatePtr state;
    for (std::int64_t i = 0; i < kFrames; ++i) {
      rerun.play_before(i);
      state = rerun.process(pictures.next(i >= moves_at ? 1 : 0),
                            session.frames().at(static_cast<std::size_t>(i)));
    }
    return state;
  }
  [[nodiscard]] static Standing standing_of(const operation::OperationStatePtr& state) {
    return state->registration->in_force.standing;
  }
  const test::TemporaryFolder folder_;
};

// Pictures that the record did not keep counted in it, and those that it kept need not tell the same: its own
// word alone counts.
TEST_F(RerunTest, ThatTheBoneHasMovedIsTheRecordsWordAlone) {
  const RecordedSession still = recorded(kNever);
  const operation::OperationStatePtr seen = run_again(still, kMovesAt);
  EXPECT_EQ(seen->contour.state, ContourState::Drifted) << "it is seen";
  EXPECT_EQ(standing_of(seen), Standing::Stands) << "and stands for nothing";
  const RecordedSession moved = recorded(kMovesAt);
  EXPECT_EQ(standing_of(run_again(moved, kNever)), Standing::Alarm);
}

// Adds what the pictures told after a frame, where it belongs among the events.
void tell_in_record(const std::filesystem::path& session, std::int64_t after_frame, std::string_view text) {
  operation::JournalEntry entry;
  entry.kind = operation::JournalKind::BoneLooks;
  entry.text = text;
  append_entries(session, {entry});
  SessionDatabase database = SessionDatabase::open(session / "session.sqlite");
  Statement later = database.prepare("UPDATE events SET id = id + 1000 WHERE after_frame > ? OR text = ?");
  later.bind(1, after_frame).bind(2, text).run();
  Statement place = database.prepare(
      "UPDATE events SET after_frame = ?, id = (SELECT MAX(id) + 1 FROM events WHERE id < 1000) WHERE text = "
      "?");
  place.bind(1, after_frame).bind(2, text).run();
}

// So it is with how the bone looks: a doubt begins and ends where the record says so, whatever the pictures
// show.
TEST_F(RerunTest, HowTheBoneLooksIsTheRecordsWordAlone) {
  using operation::ControlPointDue;
  const std::filesystem::path session = recorded(kNever).folder();
  const auto due = [&] { return run_again(RecordedSession(session), kNever)->control_point_due; };
  const ControlPointDue undoubted = due();
  EXPECT_NE(undoubted, ControlPointDue::CannotCheckLooks);
  tell_in_record(session, kMovesAt, operation::kLooksOtherwise);
  EXPECT_EQ(due(), ControlPointDue::CannotCheckLooks);
  tell_in_record(session, kMovesAt + 20, operation::kLooksAsItDid);
  EXPECT_EQ(due(), undoubted);
}

// The drill in one frame, depth_mm beyond the planned entry and 1 mm beside it; its guide is out of view.
pipeline::FrameResult with_drill(pipeline::FrameResult frame, double depth_mm) {
  const operation::PlannedTunnel plan = test::phantom_plan();
  const Eigen::Vector3d tip_mm =
      plan.tunnel.entry_mm + depth_mm * plan.tunnel.direction + plan.tunnel.direction.unitOrthogonal();
  frame.guidance.drill =
      guidance::drill_depth(plan.tunnel, plan.length_mm, tip_mm, plan.tunnel.direction, 0.3);
  frame.guidance.drill->sigma_offset_mm = 0.4;
  frame.guidance.drill->sigma_angle_deg = 0.5;
  frame.guidance.timestamp_ns = frame.timestamp_ns;
  return frame;
}

// A drill that is seen without its guide is what "drilled" rests on: from the record alone it is the same
// drill in every frame, and the same tunnel.
TEST_F(RerunTest, ADrillWithoutItsGuideIsTheSameFromTheRecordAlone) {
  test::PhantomOperation run;
  const operation::SourceSetup source = test::scripted_source();
  const std::filesystem::path folder = folder_ / "drill";
  std::filesystem::create_directory(folder);
  OperationRecord record(folder, run.operation().setup(), source, {}, "");
  record.add(run.operation().take_journal());
  run.on_journal = [&](const auto& entries) { record.add(entries); };
  run.on_frame = [&](const operation::OperationState& state) { record.add_frame(nullptr, state, false); };
  run.start(source);
  const auto trial = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  run.apply(test::true_registration(trial, operation::provenance_of(run.operation().setup(), source)));
  for (int i = 0; i <= 120; ++i) run.show(with_drill(run.frame(), std::min(0.3 * i, 25.0)));
  run.apply(operation::TunnelDrilled{});
  const auto drilled = run.state()->drilled;
  ASSERT_TRUE(drilled.tunnel);
  EXPECT_NEAR(drilled.tunnel->depth_mm.value(), 25, 0.1);
  run.operation().end_source();
  record.add(run.operation().take_journal());
  record.finish({});

  const RecordedSession session(folder);
  operation::OperationSetup setup = setup_of(session);
  setup.surface = run.operation().setup().surface;
  Rerun rerun(setup, Registrations::NotFollowed, nullptr);
  rerun.start(session);
  for (const RecordedFrame& frame : session.frames()) {
    rerun.play_before(frame.index);
    ASSERT_EQ(operation::digest_of_decisions(*rerun.process(frame)), frame.digests->decisions) << frame.index;
  }
  rerun.play_rest();
  const auto again = rerun.state()->drilled;
  ASSERT_TRUE(again.tunnel);
  EXPECT_EQ(again.tunnel->measured.entry_mm, drilled.tunnel->measured.entry_mm);
  EXPECT_EQ(again.tunnel->measured.direction, drilled.tunnel->measured.direction);
  EXPECT_EQ(again.tunnel->depth_mm, drilled.tunnel->depth_mm);
}

}  // namespace
}  // namespace arthronaut::recording
