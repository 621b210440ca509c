// What an event is called, and what it is not: a verdict that changed is no bone that was registered.
#include "navigation/recording/told_events.h"

#include <gtest/gtest.h>

#include <map>

namespace arthronaut::recording {
namespace {

SessionEvent event(std::string_view kind, const std::string& text, std::int64_t after_frame) {
  return {0, std::string(kind), text, after_frame};
}

registration::RegistrationSummary at(double x_mm) {
  registration::RegistrationSummary registration;
  registration.has_pose = true;
  registration.marker_from_bone.translation_mm = {x_mm, 0, 0};
  return registration;
}

// A pose, an alarm that began and was over, the next pose, and the marker taken out.
const std::vector<SessionEvent> kEvents{event(kRegistrationEvent, "registration_1.json", 10),
                                        event(kRegistrationEvent, "registration_2.json", 20),
                                        event(kAlarmEvent, "the control point has moved", 20),
                                        event(kRegistrationEvent, "registration_3.json", 30),
                                        event(kAlarmEvent, "", 30),
                                        event(kRegistrationEvent, "registration_4.json", 40),
                                        event(kRegistrationEvent, "registration_5.json", 50),
                                        event("anything", "else", 60)};

std::optional<registration::RegistrationSummary> read(const SessionEvent& of) {
  static const std::map<std::string, registration::RegistrationSummary> kFiles{{"registration_1.json", at(1)},
                                                                               {"registration_2.json", at(1)},
                                                                               {"registration_3.json", at(1)},
                                                                               {"registration_4.json", at(2)},
                                                                               {"registration_5.json", {}}};
  const auto file = kFiles.find(of.text);
  return file == kFiles.end() ? std::nullopt : std::optional(file->second);
}

TEST(ToldEvents, AVerdictIsNoRegistration) {
  const auto told = told_events(kEvents, read);
  ASSERT_EQ(told.size(), kEvents.size());
  std::vector<std::string> steps;
  for (const ToldEvent& one : told)
    if (one.is_of_operation) steps.push_back(one.words);
  EXPECT_EQ(steps, (std::vector<std::string>{"bone registered", "alarm", "alarm is over", "bone registered",
                                             "nothing is registered any more: no registration was run"}));
  EXPECT_EQ(told[1].words, "registration judged anew");
  EXPECT_EQ(told[1].gravity, Gravity::Note);
  EXPECT_EQ(told[2].gravity, Gravity::Alarm);
  EXPECT_EQ(told[2].detail, "the control point has moved");
  EXPECT_EQ(told[4].gravity, Gravity::Step);
  EXPECT_EQ(told[7].words, "anything");
  EXPECT_EQ(told[7].detail, "else");
}

// Why nothing is registered any more is told with it: the marker that was taken out is the end of every
// operation, and one that was bumped is not.
TEST(ToldEvents, SayWhyNothingIsRegisteredAnyMore) {
  const auto with_reason = [](const SessionEvent& of) {
    auto registration = read(of);
    if (registration && !registration->has_pose)
      registration->reasons = {"the world marker is out of the bone"};
    return registration;
  };
  const auto told = told_events(kEvents, with_reason);
  EXPECT_EQ(told[6].words, "nothing is registered any more: the world marker is out of the bone");
}

// That there was a registration its event says, whether its file can be read or not.
TEST(ToldEvents, WithoutTheFilesEachOneIsARegistration) {
  for (const ToldEvent& one : told_events(kEvents, [](const SessionEvent&) { return std::nullopt; })) {
    if (one.event->kind == kRegistrationEvent) {
      EXPECT_EQ(one.words, "bone registered");
    }
  }
  const auto none = told_events({event(kRegistrationEvent, "registration_5.json", -1)}, read);
  EXPECT_EQ(none.at(0).words, "no place of the bone was found");
}

TEST(ToldEvents, APoseIsInForceWhateverItsVerdicts) {
  const auto poses = poses_in_force(kEvents, read);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].files.size(), 3U);
  EXPECT_EQ(poses[0].after_frame, 10);
  EXPECT_EQ(poses[0].until_frame, 40);
  EXPECT_EQ(poses[1].until_frame, 50);
  // Void, and confirmed by a touch: in force again from there on.
  const auto again =
      poses_in_force({event(kRegistrationEvent, "registration_1.json", 10), event(kVoidEvent, "", 15),
                      event(kRegistrationEvent, "registration_2.json", 20)},
                     read);
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].until_frame, 15);
  EXPECT_EQ(again[1].after_frame, 20);
  EXPECT_FALSE(again[1].until_frame);
}

}  // namespace
}  // namespace arthronaut::recording
