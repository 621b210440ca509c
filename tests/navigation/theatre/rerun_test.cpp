// What a rerun takes from the record and what from the pictures, on a ball that moves under its marker, or
// does not.
#include "navigation/recording/rerun.h"

#include <gtest/gtest.h>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_database.h"
#include "tests/navigation/operation/ball_pictures.h"
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

}  // namespace
}  // namespace arthronaut::recording
