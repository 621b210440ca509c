// What moves on the time line: playing, speeds, loops, jumps, marks and their undo; without a window.
#include <gtest/gtest.h>

#include <fstream>

#include "app/review/playback.h"
#include "app/review/review_marks.h"
#include "app/review/review_panels.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

constexpr int kFrames = 121;  // two seconds and the one after it

class Looking : public ::testing::Test {
 protected:
  void SetUp() override {
    recording::SessionRecorder recorder(folder_.path(), test::session_header(), test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      recorder.append(test::frame_result(i));
      if (i == 30) recorder.add_event({test::frame_result(i).timestamp_ns, "command", R"({"command":"?"})"});
      if (i == 60) recorder.add_event({test::frame_result(i).timestamp_ns, "alarm", "the marker has moved"});
      if (i == 60) recorder.add_event({test::frame_result(i).timestamp_ns, "outcome", "1"});
      if (i == 90) recorder.add_event({test::frame_result(i).timestamp_ns, "alarm", ""});
    }
    recorder.finish();
    timeline_ = std::make_unique<recording::SessionTimeline>(folder_.path());
  }
  const test::TemporaryFolder folder_;
  std::unique_ptr<recording::SessionTimeline> timeline_;
};

// At the pace it happened: after half a second frame 30 of 60 a second is on the screen; twice as fast, a
// quarter of a second later, frame 60; at the end it stops, and starts from the beginning the next time.
TEST_F(Looking, PlaysAtThePaceThatIsSet) {
  Playback playback;
  toggle_play(playback, *timeline_, 100);
  advance(playback, *timeline_, 100.5 + 1e-6);
  EXPECT_EQ(playback.frame, 30U);
  change_speed(playback, *timeline_, 1, 100.5 + 1e-6);
  EXPECT_EQ(speed_text(playback), "2 x");
  advance(playback, *timeline_, 100.75 + 2e-6);
  EXPECT_EQ(playback.frame, 60U);
  advance(playback, *timeline_, 300);
  EXPECT_EQ(playback.frame, static_cast<std::size_t>(kFrames - 1));
  EXPECT_FALSE(playback.plays);
  toggle_play(playback, *timeline_, 300);
  EXPECT_EQ(playback.frame, 0U);
  for (int i = 0; i < 20; ++i) change_speed(playback, *timeline_, -1, 300);
  EXPECT_EQ(speed_text(playback), "1/8 x");
}

TEST_F(Looking, GoesRoundInALoopWhicheverEndWasSetFirst) {
  Playback playback;
  playback.frame = 90;
  set_loop(playback);
  EXPECT_FALSE(playback.loops());
  playback.frame = 60;
  set_loop(playback);
  ASSERT_TRUE(playback.loops());
  EXPECT_EQ(*playback.from, 60U);
  EXPECT_EQ(*playback.to, 90U);
  toggle_play(playback, *timeline_, 0);
  advance(playback, *timeline_, 0.25 + 1e-6);
  EXPECT_EQ(playback.frame, 75U);
  advance(playback, *timeline_, 0.51);
  EXPECT_EQ(playback.frame, 60U);
  EXPECT_TRUE(playback.plays);
  set_loop(playback);
  EXPECT_FALSE(playback.from);
}

// Alarms and commands stand where they came, in words; what the record keeps for itself is not told.
TEST_F(Looking, TellsWhatHappenedAndJumpsToIt) {
  const recording::SessionOverview session = recording::read_overview(folder_.path());
  const recording::ReadRegistration pose = [](const recording::SessionEvent&) {
    registration::RegistrationSummary same;
    same.has_pose = true;
    return std::optional(same);
  };
  const auto moments = moments_of(session.events, *timeline_, pose);
  ASSERT_EQ(moments.size(), 3U);
  EXPECT_EQ(moments[0].frame, 30U);
  EXPECT_EQ(moments[0].kind, MomentKind::Command);
  EXPECT_EQ(moments[0].words, "Command that this version does not know");
  EXPECT_EQ(moments[1].words, "Alarm: the marker has moved");
  EXPECT_EQ(moments[1].kind, MomentKind::Alarm);
  EXPECT_EQ(moments[2].words, "Alarm is over");
  // Each verdict writes its registration: the alarm's beginning is no step of the operation.
  const auto verdicts =
      moments_of({{0, std::string(recording::kRegistrationEvent), "registration_1.json", 10},
                  {0, std::string(recording::kRegistrationEvent), "registration_2.json", 60}},
                 *timeline_, pose);
  ASSERT_EQ(verdicts.size(), 2U);
  EXPECT_EQ(verdicts[0].words, "Bone registered");
  EXPECT_EQ(verdicts[0].kind, MomentKind::Step);
  EXPECT_EQ(verdicts[1].words, "Registration judged anew");
  EXPECT_EQ(verdicts[1].kind, MomentKind::Note);
  const auto frames = frames_to_jump_to(moments, {{45, 0, "here"}}, *timeline_);
  EXPECT_EQ(frames, (std::vector<std::size_t>{30, 45, 60, 90}));
  EXPECT_EQ(moment_after(frames, 30), 45U);
  EXPECT_EQ(moment_before(frames, 60), 45U);
  EXPECT_FALSE(moment_after(frames, 90) || moment_before(frames, 30));
}

// What is said after the last picture stands at its own time, as in the report; what has none, at its
// frame's.
TEST_F(Looking, TellsWhatComesAfterThePicturesByTheRecordsClock) {
  const std::size_t last = timeline_->frames().size() - 1;
  const recording::FrameGlance &first = timeline_->frames().front(), &end = timeline_->frames()[last];
  const auto moments =
      moments_of({{end.timestamp_ns + 6'000'000'000, std::string(recording::kDrilledEvent), "", end.index},
                  {0, "note", "", end.index}},
                 *timeline_, {});
  ASSERT_EQ(moments.size(), 2U);
  EXPECT_EQ(moments[0].frame, last);
  EXPECT_NEAR(moments[0].time_s, static_cast<double>(end.timestamp_ns - first.timestamp_ns) * 1e-9 + 6, 1e-9);
  EXPECT_EQ(moments[1].time_s, timeline_->time_s(last));
  // Beside the cursor, which stands at the last picture, the clock is the list's.
  EXPECT_EQ(last_moment_in_words({moments[0]}, *timeline_, last),
            recording::clock_text(moments[0].time_s) + ", after the pictures: " + moments[0].words);
  EXPECT_EQ(last_moment_in_words({moments[1]}, *timeline_, last), moments[1].words);
  EXPECT_EQ(last_moment_in_words({moments[0]}, *timeline_, 0), "");
}

// What was asked for is told in words, and not as a program has it.
TEST_F(Looking, TellsDrawingInWords) {
  const auto moments = moments_of({{0, "command", operation::to_text(operation::Draw{true}), 10},
                                   {0, "command", operation::to_text(operation::Draw{false}), 20}},
                                  *timeline_, {});
  ASSERT_EQ(moments.size(), 2U);
  EXPECT_EQ(moments[0].words, "Asked for: probe draws");
  EXPECT_EQ(moments[1].words, "Asked for: probe stops drawing");
}

// A guide that is further off than the strip shows is a flat line there: where it is so is told.
TEST_F(Looking, MarksWhatTheOffsetsStripCannotShow) {
  std::vector<recording::FrameGlance> frames(6);
  for (auto& frame : frames) {
    frame.guidance = guidance::GuidanceState::Valid;
    frame.offset_mm = 18;
  }
  frames[0].offset_mm = 6;
  frames[3].guidance = guidance::GuidanceState::NoPlan;
  const auto beyond = beyond_strip(frames, 6);
  ASSERT_EQ(beyond.size(), 2U);
  EXPECT_EQ(beyond[0].first, 1U);
  EXPECT_EQ(beyond[0].last, 2U);
  EXPECT_EQ(beyond[1].first, 4U);
  EXPECT_EQ(beyond[1].last, 5U);
}

// An operation says its plan when it is made and again when its source starts: it came into force once.
TEST_F(Looking, TellsAPlanOnceUntilItChanges) {
  const auto plan = [](std::int64_t after, const char* text) {
    return recording::SessionEvent{0, std::string(recording::kPlanEvent), text, after};
  };
  const auto moments = moments_of({plan(-1, "a"), plan(-1, "a"), plan(30, "b"), plan(40, ""), plan(50, "b")},
                                  *timeline_, [](const recording::SessionEvent&) { return std::nullopt; });
  ASSERT_EQ(moments.size(), 4U);
  EXPECT_EQ(moments[0].words, "Plan in force");
  EXPECT_EQ(moments[1].frame, 30U);
  EXPECT_EQ(moments[2].words, "No plan in force");
  EXPECT_EQ(moments[3].frame, 50U);
}

// Every change is on disk at once; undo and redo write, too; another change after an undo ends the redo.
TEST_F(Looking, KeepsMarksWithUndo) {
  MarkBook book(folder_.path(), "");
  book.put({30, 1, "first touch"});
  book.put({10, 2, ""});
  book.put({30, 1, "first touch, too lateral"});
  EXPECT_EQ(recording::read_marks(folder_.path()), book.marks());
  ASSERT_EQ(book.marks().size(), 2U);
  EXPECT_EQ(book.marks().front().frame, 10);
  book.remove(10);
  book.remove(10);  // no step
  book.undo();
  book.undo();
  EXPECT_EQ(recording::read_marks(folder_.path()).back().note, "first touch");
  book.redo();
  EXPECT_EQ(recording::read_marks(folder_.path()).back().note, "first touch, too lateral");
  book.put({50, 3, "x"});
  EXPECT_FALSE(book.can_redo());
  EXPECT_EQ(MarkBook(folder_.path(), "").marks(), book.marks());
}

// What cannot be read is said, and never written over; a case that is read-only takes no mark.
TEST_F(Looking, WritesNoMarkOverWhatItCannotRead) {
  std::ofstream(recording::marks_file(folder_.path()))
      << "{\"format\": \"arthronaut.marks\", \"version\": 9}";
  MarkBook broken(folder_.path(), "");
  EXPECT_NE(broken.problem().find("marks.json"), std::string::npos);
  broken.put({1, 1, "lost?"});
  EXPECT_TRUE(broken.marks().empty());
  EXPECT_FALSE(MarkBook(folder_.path(), "is open elsewhere").problem().empty());
}

// Within the panel where there is room on either side, and over no other note.
TEST(TimeLine, NotesStayInThePanel) {
  const NoteRoom room{100, 500};
  EXPECT_EQ(note_left(200, 150, 10, room), 210);
  EXPECT_EQ(note_left(490, 150, 10, room), 490 - 10 - 150);
  EXPECT_EQ(note_left(200, 390, 10, room), 210) << "fits nowhere: cut off at its end";
}

// A loop beside the part that is zoomed to was drawn beside the time line.
TEST(TimeLine, WhatLiesBesideThePartShownIsNotDrawn) {
  EXPECT_FALSE(within({20, 80}, {100, 500}));
  EXPECT_FALSE(within({510, 700}, {100, 500}));
  const auto seen = within({20, 180}, {100, 500});
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->from, 100);
  EXPECT_EQ(seen->to, 180);
}

// The place under the mouse stays under it; never less than asked for, never more than all.
TEST(TimeLine, ZoomsAboutTheMouse) {
  TimeLineZoom zoom = zoomed({}, 0.25, 0.5, 0.01);
  EXPECT_NEAR(zoom.from + 0.25 * (zoom.to - zoom.from), 0.25, 1e-12);
  EXPECT_NEAR(zoom.to - zoom.from, 0.5, 1e-12);
  for (int i = 0; i < 30; ++i) zoom = zoomed(zoom, 1, 0.5, 0.01);
  EXPECT_NEAR(zoom.to - zoom.from, 0.01, 1e-12);
  for (int i = 0; i < 30; ++i) zoom = zoomed(zoom, 0, 2, 0.01);
  EXPECT_EQ(zoom.from, 0);
  EXPECT_EQ(zoom.to, 1);
}

}  // namespace
}  // namespace arthronaut::review
