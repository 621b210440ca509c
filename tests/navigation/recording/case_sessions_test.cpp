#include "navigation/recording/case_sessions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "navigation/recording/session.h"
#include "navigation/sources/exercise_source.h"
#include "planning/cases/case.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CaseSessions : public ::testing::Test {
 protected:
  // A session with a registration; its RMS tells which it is.
  std::filesystem::path add_session(double rms_mm, bool reliable, const std::string& alarm = {}) {
    return add_session(test::session_header(), rms_mm, reliable, alarm);
  }
  std::filesystem::path add_session(const SessionHeader& header, double rms_mm, bool reliable,
                                    const std::string& alarm = {}) {
    const auto folder = cases::create_session_folder(temporary_.path());
    SessionRecorder recorder(folder, header, options_);
    registration::RegistrationSummary registration;
    registration.has_pose = true;
    registration.reliable = reliable;
    registration.rms_mm = rms_mm;
    registration.reasons.clear();
    if (!reliable) registration.reasons = {"too few points"};
    recorder.set_registration(registration);
    if (!alarm.empty()) recorder.add_event({0, "alarm", alarm});
    recorder.finish();
    return folder;
  }
  [[nodiscard]] std::optional<KnownRegistration> found() const {
    return find_registration(temporary_.path(), test::session_header().bone, options_.tools);
  }

  const test::TemporaryFolder temporary_;
  const pipeline::PipelineOptions options_ = test::scripted_options();
};

TEST_F(CaseSessions, TheNewestSessionsRegistrationIsFound) {
  EXPECT_FALSE(found().has_value());
  add_session(0.1, true);
  const auto newest = add_session(0.2, true);
  ASSERT_TRUE(found().has_value());
  EXPECT_TRUE(found()->is_usable());
  EXPECT_EQ(found()->session_folder, newest);
  EXPECT_EQ(found()->registration.rms_mm, 0.2);
  EXPECT_THAT(found()->passed_over, IsEmpty());
}

// Hazard 16: what the newest session says counts, also when it is that there is nothing to guide by.
TEST_F(CaseSessions, Hazard16AnOlderRegistrationIsNotTakenForAnUnreliableNewerOne) {
  add_session(0.1, true);
  const auto newest = add_session(0.9, false);
  ASSERT_TRUE(found().has_value());
  EXPECT_FALSE(found()->is_usable());
  EXPECT_EQ(found()->session_folder, newest);
  EXPECT_THAT(found()->refusal, HasSubstr("too few points"));
}

TEST_F(CaseSessions, Hazard16AnOlderRegistrationIsNotTakenAfterAnAlarm) {
  add_session(0.1, true);
  const auto newest = add_session(0.2, true, "the world marker was moved");
  ASSERT_TRUE(found().has_value());
  EXPECT_FALSE(found()->is_usable());
  EXPECT_EQ(found()->session_folder, newest);
  EXPECT_THAT(found()->refusal, HasSubstr("the world marker was moved"));
}

// As when an operation is resumed: that an alarm is over is no registration that guides again.
TEST_F(CaseSessions, Hazard16AnAlarmIsOverOnceSomethingGuidesAgain) {
  const auto session = add_session(0.2, true, "the world marker was moved");
  append_event(session, {0, std::string(kAlarmEvent), ""});
  EXPECT_FALSE(found()->is_usable());
  append_event(session, {0, std::string(kRegistrationEvent), "registration_1.json"});
  EXPECT_TRUE(found()->is_usable());
}

// Hazard 40: what was known in an exercise is no registration of the case.
TEST_F(CaseSessions, Hazard40AnExercisesRegistrationIsNotFound) {
  SessionHeader header = test::session_header();
  header.source_kind = sources::SourceKind::Simulation;
  header.source = sources::kExerciseSource;
  const auto operation = add_session(0.2, true);
  const auto exercise = add_session(header, 0.1, true);
  ASSERT_TRUE(found().has_value());
  EXPECT_EQ(found()->session_folder, operation);
  EXPECT_TRUE(is_exercise(exercise));
  EXPECT_FALSE(is_exercise(operation));
  EXPECT_EQ(operation_folders(temporary_.path()), std::vector{operation});
}

// Hazard 40: a case is somebody's as soon as one of its sessions is, or may be.
TEST_F(CaseSessions, Hazard40ARealSessionIsNamed) {
  SessionHeader header = test::session_header();
  header.source_kind = sources::SourceKind::Simulation;
  add_session(header, 0.1, true);
  EXPECT_EQ(real_session(temporary_.path()), "");
  header.source_kind = sources::SourceKind::Live;
  const auto live = add_session(header, 0.1, true);
  EXPECT_THAT(real_session(temporary_.path()), HasSubstr(live.filename().string()));
  EXPECT_THAT(real_session(temporary_.path()), HasSubstr("live"));
  add_session(header, 0.1, true);
  std::ofstream(live / "session.json") << "{";
  EXPECT_THAT(real_session(temporary_.path()), HasSubstr("cannot be read"));
}
TEST_F(CaseSessions, Hazard40ASessionOfUnknownKindCountsAsReal) {
  SessionHeader header = test::session_header();
  header.source_kind.reset();
  add_session(header, 0.1, true);
  EXPECT_THAT(real_session(temporary_.path()), HasSubstr("may be of a patient"));
}

// A session that cannot be read is passed over, and never silently.
TEST_F(CaseSessions, Hazard16ABrokenNewerSessionIsNamed) {
  const auto older = add_session(0.1, true);
  const auto broken = add_session(0.2, true);
  std::ofstream(broken / "registration.json") << "{";
  ASSERT_TRUE(found().has_value());
  EXPECT_EQ(found()->session_folder, older);
  ASSERT_EQ(found()->passed_over.size(), 1U);
  EXPECT_THAT(found()->passed_over[0], HasSubstr(broken.filename().string()));
}

}  // namespace
}  // namespace arthronaut::recording
