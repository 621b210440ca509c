#include "app/report/session_rows.h"

#include <gtest/gtest.h>

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
    header.source_kind = kind;
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
  EXPECT_EQ(safety_rows(session, "").at(1).at(1), "verified by touches");
  const std::vector<Step> steps = steps_of(session);
  EXPECT_EQ(steps.front().words, "bone registered");
  EXPECT_EQ(steps.back().words, "nothing is registered any more");
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
  EXPECT_EQ(safety_rows(recording::RecordedSession(folder.path()), "").back().at(1),
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

}  // namespace
}  // namespace arthronaut::report
