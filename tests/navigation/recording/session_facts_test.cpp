#include "navigation/recording/session_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "navigation/sources/exercise_source.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMinute_ns = 60'000'000'000;

class SessionFactsTest : public ::testing::Test {
 protected:
  SessionFactsTest() {
    std::filesystem::create_directories(session_);
    registration_.has_pose = registration_.reliable = true;
    registration_.reasons.clear();
    registration_.rms_mm = 0.2;
    registration_.predicted_tre_mm = 0.6;
  }
  // First frame after a minute of the source's clock; then the events, minutes after it.
  void record(const std::vector<std::pair<double, std::string_view>>& events, bool finishes = true) {
    SessionRecorder recorder(session_, header_, options_);
    pipeline::FrameResult frame = test::frame_result(0);
    frame.timestamp_ns = kMinute_ns;
    recorder.append(frame);
    int registration_count = 0;
    for (const auto& [minutes, kind] : events) {
      std::string text = kind == kAlarmEvent ? "the marker was bumped" : "";
      if (kind == kRegistrationEvent) {
        recorder.set_registration(registration_);
        text = "registration_" + std::to_string(++registration_count) + ".json";
      }
      const auto at = kMinute_ns + static_cast<std::int64_t>(minutes * static_cast<double>(kMinute_ns));
      recorder.add_event({at, std::string(kind), text});
      // As the operation records that the marker was taken out.
      registration_.has_pose = registration_.reliable = kind != kDrilledEvent;
      if (kind == kDrilledEvent) registration_.reasons = {"the world marker was placed anew"};
    }
    if (finishes) recorder.finish();
  }
  [[nodiscard]] library::SessionFacts read() const { return read_session_facts(session_); }

  const test::TemporaryFolder folder_;
  const std::filesystem::path session_ = folder_ / "0001-20260131-120000";
  const pipeline::PipelineOptions options_ = test::scripted_options();
  registration::RegistrationSummary registration_;
  SessionHeader header_ = [] {
    SessionHeader header = test::session_header();
    header.source_kind = sources::SourceKind::Live;
    return header;
  }();
};

// Steps by the clock of the events; the tunnel 3 mm beside and 10 degrees off the plan by construction.
TEST_F(SessionFactsTest, SaysStepsRegistrationAndWhatWasReached) {
  operation::AchievedTunnel achieved;
  achieved.planned.direction = Eigen::Vector3d::UnitZ();
  achieved.measured = achieved.planned;
  achieved.measured.entry_mm = achieved.planned.entry_mm + Eigen::Vector3d(0, 3, 0);
  achieved.measured.direction =
      Eigen::AngleAxisd(geometry::rad_from_deg(10), Eigen::Vector3d::UnitX()) * Eigen::Vector3d::UnitZ();
  achieved.depth_mm = 30;
  record({{0.0, kAlarmEvent}, {2.5, kVerifiedEvent}, {6.0, kDrilledEvent}});
  operation::write_achieved_file(session_ / "achieved.json", achieved);
  const library::SessionFacts facts = read();
  EXPECT_EQ(facts.problem, "");
  EXPECT_EQ(facts.id, "0001-20260131-120000");
  EXPECT_EQ(facts.started_utc, "2026-01-02T03:04:05Z");
  EXPECT_EQ(facts.bone, bones::BoneKind::Femur);
  EXPECT_EQ(facts.source_kind, "live");
  EXPECT_TRUE(facts.was_finished);
  EXPECT_TRUE(facts.was_verified);
  EXPECT_EQ(facts.alarm_count, 1);
  EXPECT_NEAR(facts.entry_offset_mm.value(), 3, 1e-9);
  EXPECT_NEAR(facts.angle_deg.value(), 10, 1e-9);
  EXPECT_EQ(facts.depth_mm, 30);
  EXPECT_FALSE(facts.registering_min.has_value()) << "nothing was registered";
  EXPECT_FALSE(facts.verifying_min.has_value());
  EXPECT_NEAR(facts.drilling_min.value(), 3.5, 1e-9) << "from the verification on";
}

TEST_F(SessionFactsTest, SaysTheRegistration) {
  record({{1.0, kRegistrationEvent}, {3.0, kConfirmedEvent}});
  const library::SessionFacts facts = read();
  EXPECT_EQ(facts.registration_is_reliable, true);
  EXPECT_EQ(facts.registration_rms_mm, 0.2);
  EXPECT_EQ(facts.predicted_error_mm, 0.6);
  EXPECT_FALSE(facts.was_verified) << "one touch confirms but does not verify";
  EXPECT_TRUE(facts.registering_min.has_value());
  EXPECT_TRUE(facts.verifying_min.has_value());
  EXPECT_FALSE(facts.is_drilled());
}

// A tunnel that somebody said is drilled, and that no pose shows, is no tunnel that is not drilled.
TEST_F(SessionFactsTest, SaysWhatWasDrilledByWordAlone) {
  record({{1.0, kRegistrationEvent}, {3.0, kDrilledByWordEvent}});
  EXPECT_TRUE(read().is_drilled_by_word);
  EXPECT_FALSE(read().is_drilled());
  EXPECT_EQ(read().outcome(), "registered, drilled by word alone");
  EXPECT_TRUE(read().is_in_doubt());
  std::filesystem::remove_all(session_);
  std::filesystem::create_directories(session_);
  record({{1.0, kRegistrationEvent}, {3.0, kDrilledByWordEvent}, {4.0, kSaidTooEarlyEvent}});
  EXPECT_FALSE(read().is_drilled_by_word) << "it was taken back";
}

// By its frames, whatever the events say: half a minute between the first and the last.
TEST_F(SessionFactsTest, SaysHowLongItWas) {
  record({{9.0, kAlarmEvent}});
  EXPECT_EQ(read().length_min, 0) << "one frame";
  std::filesystem::remove_all(session_);
  std::filesystem::create_directories(session_);
  {
    SessionRecorder recorder(session_, header_, options_);
    for (const int i : {0, 1, 2}) {
      pipeline::FrameResult frame = test::frame_result(i);
      frame.timestamp_ns = kMinute_ns + i * kMinute_ns / 4;
      recorder.append(frame);
    }
    recorder.finish();
  }
  EXPECT_NEAR(read().length_min.value(), 0.5, 1e-9);
}

TEST_F(SessionFactsTest, AVoidRegistrationIsNotReliable) {
  record({{1.0, kRegistrationEvent}, {2.0, kVerifiedEvent}, {3.0, kVoidEvent}});
  EXPECT_EQ(read().registration_is_reliable, false);
  EXPECT_FALSE(read().was_verified);
}

// The marker is taken out at the end of every operation: what was drilled before rests on what stood then.
TEST_F(SessionFactsTest, ATunnelCountsByTheRegistrationThatItWasDrilledBy) {
  record({{1.0, kRegistrationEvent}, {2.0, kVerifiedEvent}, {3.0, kDrilledEvent}, {4.0, kRegistrationEvent}});
  const library::SessionFacts facts = read();
  EXPECT_EQ(facts.registration_is_reliable, true);
  EXPECT_TRUE(facts.was_verified);
  EXPECT_EQ(facts.predicted_error_mm, 0.6);
}

TEST_F(SessionFactsTest, WhatVerifiedOneRegistrationDoesNotVerifyTheNext) {
  record({{1.0, kRegistrationEvent}, {2.0, kVerifiedEvent}, {3.0, kRegistrationEvent}});
  EXPECT_FALSE(read().was_verified);
}

// Hazard 40: whoever counts sessions has to be told.
TEST_F(SessionFactsTest, Hazard40SaysThatItIsAnExercise) {
  header_.source_kind = sources::SourceKind::Simulation;
  record({{1.0, kRegistrationEvent}});
  EXPECT_FALSE(read().is_exercise) << "a simulated operation";
  std::filesystem::remove_all(session_);
  std::filesystem::create_directories(session_);
  header_.source = sources::kExerciseSource;
  record({{1.0, kRegistrationEvent}});
  EXPECT_TRUE(read().is_exercise);
}

TEST_F(SessionFactsTest, TellsWhatIsWholeOfABrokenSession) {
  record({{1.0, kRegistrationEvent}});
  std::ofstream(session_ / "session.sqlite") << "broken";
  const library::SessionFacts facts = read();
  EXPECT_THAT(facts.problem, HasSubstr("session.sqlite"));
  EXPECT_EQ(facts.predicted_error_mm, 0.6);
  EXPECT_EQ(facts.bone, bones::BoneKind::Femur);
  EXPECT_THAT(read_session_facts(folder_ / "none").problem, HasSubstr("none"));
}

}  // namespace
}  // namespace arthronaut::recording
