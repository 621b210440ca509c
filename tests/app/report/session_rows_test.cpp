#include "app/report/session_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/report/plans_in_force.h"
#include "app/report/source_faults.h"
#include "navigation/operation/command.h"
#include "navigation/tools/tool_set.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {
namespace {

pipeline::PipelineOptions options() {
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  return options;
}

// A file may be called after its patient; nothing else is.
TEST(SessionRows, Hazard19ARecordingsFileIsNotNamed) {
  const auto neutral = [](const char* kind, const char* source) {
    recording::SessionHeader header;
    header.source_kind = sources::source_kind_from_text(kind);
    header.source = source;
    return neutral_source(header);
  };
  EXPECT_EQ(neutral("recording", "/media/Mueller, Jane.mkv"), "recording (mkv)");
  for (const char* named : {"Mueller_Jane", "Dr. Mueller Jane", "/media/Jane.Mueller"})
    EXPECT_EQ(neutral("recording", named), "recording") << named;
  EXPECT_EQ(neutral("", "Mueller_Jane"), "recording") << "an old session does not say of what kind it is";
  EXPECT_EQ(neutral("simulation", "Simulated operation: drill"), "Simulated operation: drill");
  for (const char* source :
       {"Capture card", "udp://127.0.0.1:5000", "rtsp://tower.or3/scope.sdp", "gst:videotestsrc ! appsink"})
    EXPECT_EQ(neutral("live", source), source);
}

// The side of a case may be set right after an operation was recorded: its pages say as which it was.
TEST(SessionRows, SaysOfWhichSideItWasRecorded) {
  recording::SessionHeader header;
  header.side = bones::Side::Left;
  EXPECT_EQ(bone_in_words(header, bones::Side::Left), "femur");
  EXPECT_EQ(bone_in_words(header, bones::Side::Right),
            "femur, recorded as of a left knee: THE CASE IS A RIGHT ONE NOW");
}

// The marker is taken out at the end of every operation: what was drilled before rests on what stood then.
TEST(SessionRows, ATunnelIsToldOfByTheRegistrationThatItWasDrilledBy) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), {}, options());
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = true;
    registration.reasons.clear();
    recorder.set_registration(registration);
    recorder.add_event({1, std::string(recording::kVerifiedEvent), "", -1});
    recorder.add_event({2, std::string(recording::kDrilledEvent), "achieved.json", -1});
    registration.has_pose = registration.reliable = false;
    registration.reasons = {"the world marker was placed anew"};
    recorder.set_registration(registration);
    recorder.finish();
  }
  const recording::RecordedSession session(folder.path());
  ASSERT_FALSE(session.registration()->reliable);
  EXPECT_TRUE(registration_that_counts(session)->reliable);
  EXPECT_EQ(safety_of(session, false).verification, Safety::Verification::ByTouches);
  const std::vector<Step> steps = steps_of(session);
  EXPECT_EQ(steps.front().words, "bone registered");
  EXPECT_EQ(steps.back().words, "nothing is registered any more: the world marker was placed anew");
}

// An alarm that comes and goes filled a page with the same words.
TEST(SessionRows, AlarmsAlikeAreToldOnceWithTheirNumber) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), {}, options());
    for (std::int64_t i = 0; i < 3; ++i) {
      recorder.add_event({2 * i, std::string(recording::kAlarmEvent), "the control point has moved", -1});
      recorder.add_event({2 * i + 1, std::string(recording::kAlarmEvent), "", -1});
    }
    recorder.add_event({7, std::string(recording::kVoidEvent), "another camera", -1});
    recorder.finish();
  }
  EXPECT_EQ(alarms_in_words(safety_of(recording::RecordedSession(folder.path()), false)),
            "the control point has moved (3 times); over (3 times); another camera");
}

// Hazard 27: that nothing stood since the markers looked as in another medium is told of the session
// afterwards.
TEST(SessionRows, Hazard27AMediumThatWasContradictedIsToldOf) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), {}, options());
    for (int i = 0; i < 8; ++i) {
      pipeline::FrameResult frame;
      frame.frame_index = i;
      frame.timestamp_ns = i * 16'000'000;
      if (i >= 2) frame.guidance.state = guidance::GuidanceState::WrongMedium;
      recorder.append(frame);
    }
    recorder.finish();
  }
  EXPECT_EQ(figures_of(recording::RecordedSession(folder.path())).other_medium_percent, 75);
}

pipeline::FrameResult frame_at(std::int64_t index, double time_s) {
  pipeline::FrameResult frame;
  frame.frame_index = index;
  frame.timestamp_ns = static_cast<std::int64_t>(std::llround(1e9 * time_s));
  return frame;
}

recording::SessionEvent event_at(double time_s, std::string_view kind, const std::string& text = "") {
  return {static_cast<std::int64_t>(std::llround(1e9 * time_s)), std::string(kind), text, -1};
}

std::string row_of(const Safety& safety, const std::string& name) {
  for (const auto& row : rows_of(safety))
    if (row.front() == name) return row.back();
  return "no such row";
}

recording::SessionHeader live_header() {
  recording::SessionHeader header;
  header.source_kind = sources::SourceKind::Live;
  return header;
}

// The plan that the time-out was confirmed of, and the one that was taken over after it, each with when; what
// the case was planned to be after the pictures had ended guided nothing.
TEST(SessionRows, Hazard5NameEachPlanThatGuidedAndWhichWasConfirmed) {
  const test::TemporaryFolder folder;
  tunnels::Tunnel plan;
  plan.diameter_mm = 8;
  {
    recording::SessionRecorder recorder(folder.path(), live_header(), options());
    recorder.set_plan(plan, 30);  // replaced before the first picture
    recorder.set_plan(plan, 41.1);
    recorder.append(frame_at(0, 0));
    recorder.add_event(event_at(0, recording::kTimeOutConfirmedEvent, "right femur"));
    recorder.append(frame_at(1, 33.4));
    recorder.set_plan(plan, 25.5);
    recorder.set_plan(plan, 25.5);  // said again
    recorder.add_event(event_at(34, recording::kSourceEndedEvent));
    recorder.set_plan(plan, 41.1);
    recorder.finish();
  }
  const recording::RecordedSession session(folder.path());
  EXPECT_EQ(plans_in_words(plans_in_force(session)),
            "femur, 8.0 mm wide, 41.1 mm long; from 0:33.4 femur, 8.0 mm wide, 25.5 mm long");
  EXPECT_EQ(row_of(safety_of(session, false), "Time-out"),
            "confirmed of the plan femur, 8.0 mm wide, 41.1 mm long; NOT CONFIRMED of the plan after it");
  const std::vector<Step> steps = steps_of(session);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps.back().words, "ANOTHER PLAN TAKEN OVER: femur, 8.0 mm wide, 25.5 mm long");
  EXPECT_DOUBLE_EQ(steps.back().time_s, 33.4);
}

// A time-out that nobody saw a picture beside says so, however its event is worded.
TEST(SessionRows, SayWhatWasWrongBesideTheTimeOut) {
  const auto time_out_after = [](const operation::ConfirmTimeOut& word) {
    const test::TemporaryFolder folder;
    {
      recording::SessionRecorder recorder(folder.path(), live_header(), options());
      recorder.append(frame_at(0, 0));
      recorder.add_event(event_at(0, recording::kCommandEvent, operation::to_text(operation::Command(word))));
      recorder.add_event(event_at(0, recording::kTimeOutConfirmedEvent, "right femur"));
      recorder.finish();
    }
    return row_of(safety_of(recording::RecordedSession(folder.path()), false), "Time-out");
  };
  EXPECT_EQ(time_out_after({true, "torn picture"}), "confirmed; BESIDE torn picture");
  EXPECT_EQ(time_out_after({true, ""}), "confirmed");
}

// Pictures that did not come, and those that were late, are two things: each loss is a step with how long it
// took, whatever the words for it were meanwhile, and the figures say that the frames are those that came.
TEST(SessionRows, TellOfEveryLossOfTheSource) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), live_header(), options());
    for (int i = 0; i <= 10; ++i) recorder.append(frame_at(i, 0.1 * i));
    recorder.add_event(event_at(1.4, recording::kSourceTroubleEvent, "no picture; No picture comes"));
    recorder.add_event(
        event_at(2.4, recording::kSourceTroubleEvent, "no picture; No picture comes: broke off"));
    recorder.append(frame_at(11, 11));
    recorder.add_event(event_at(11, recording::kSourceTroubleEvent,
                                "late pictures; Pictures are late: 151 ms from capture"));
    recorder.append(frame_at(12, 11.2));
    recorder.add_event(event_at(11.2, recording::kSourceTroubleEvent, ""));
    recorder.add_event(event_at(11.6, recording::kSourceTroubleEvent, "no picture; No picture comes"));
    recorder.add_event(event_at(13.2, recording::kSourceEndedEvent));
    recorder.finish();
  }
  const recording::RecordedSession session(folder.path());
  EXPECT_EQ(row_of(safety_of(session, false), "Faults of the source"),
            "no picture 2 times, 11.2 s in all; late pictures once, 0.2 s");
  EXPECT_NEAR(figures_of(session).without_picture_s, 12, 1e-9) << "from 1 to 11 s, and from 11.2 to 13.2 s";
  EXPECT_EQ(frames_in_words(figures_of(session)), "13 in 0:11.2; NO PICTURE for 12.0 s");
  const std::vector<Step> steps = steps_of(session);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps.front().words, "SOURCE: NO PICTURE, for 9.6 s");
  EXPECT_EQ(steps.back().words, "SOURCE: NO PICTURE, for 1.6 s");
}

// What is said after the pictures is not what they showed.
TEST(SessionRows, Hazard29SayThatTheWordCameAfterThePictures) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), {}, options());
    recorder.append(frame_at(0, 0));
    recorder.append(frame_at(1, 3.6));
    recorder.add_event(event_at(3.6, recording::kSourceEndedEvent));
    recorder.add_event(event_at(38.6, recording::kDrilledEvent, "achieved.json"));
    recorder.finish();
  }
  operation::AchievedTunnel achieved;
  achieved.timestamp_ns = 3'500'000'000;
  EXPECT_EQ(seen_and_said(recording::RecordedSession(folder.path()), achieved),
            ", the last at 0:03.5; said to be drilled at 0:38.6, after the pictures had ended");
}

}  // namespace
}  // namespace arthronaut::report
