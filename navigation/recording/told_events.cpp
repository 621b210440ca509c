#include "navigation/recording/told_events.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::recording {

namespace {

struct Name {
  std::string_view kind, words;
  Gravity gravity;
  bool is_of_operation;
  bool has_file;  // the text is the name of a file, and says nothing to a person
};

// Kinds that are not here are notes by the name of their kind.
constexpr std::array kNames{
    Name{kRegistrationEvent, "bone registered", Gravity::Step, true, true},
    Name{kGivenRegistrationEvent, "registration brought along", Gravity::Step, true, true},
    Name{kVerifiedEvent, "registration verified", Gravity::Step, true, false},
    Name{kVerificationLostEvent, "verification lost", Gravity::Alarm, true, false},
    Name{kConfirmedEvent, "registration confirmed", Gravity::Step, true, false},
    Name{kVerificationSkippedEvent, "verification skipped", Gravity::Alarm, true, false},
    Name{kAlarmEvent, "alarm", Gravity::Alarm, true, false},
    Name{kVoidEvent, "registration void", Gravity::Alarm, true, false},
    Name{kTimeOutConfirmedEvent, "time-out confirmed", Gravity::Step, true, false},
    Name{kDrilledEvent, "tunnel drilled", Gravity::Step, true, true},
    Name{kDrilledByWordEvent, "tunnel drilled, by word alone", Gravity::Step, true, false},
    Name{kDrilledTakenBackEvent, "said too early: not drilled", Gravity::Step, true, true},
    Name{kSaidTooEarlyEvent, "said too early: not drilled", Gravity::Step, true, false},
    Name{kMarkerOutEvent, "world marker out", Gravity::Step, true, false},
    Name{kDroppedPicturesEvent, "pictures dropped", Gravity::Alarm, false, false},
    Name{kVideoStoppedEvent, "video stopped", Gravity::Alarm, false, false},
    Name{kRecordingStoppedEvent, "recording stopped", Gravity::Alarm, false, false}};

// By the numbers of its file, which come back as they were written.
bool is_same(const geometry::RigidTransform& a, const geometry::RigidTransform& b) {
  constexpr double kSame = 1e-9;
  return (a.translation_mm - b.translation_mm).norm() < kSame &&
         a.rotation.angularDistance(b.rotation) < kSame;
}

// Of one registration event after the other.
class PoseFollower {
 public:
  explicit PoseFollower(const ReadRegistration& read) : read_(read) {}

  enum class Change { Pose, Verdict, NoPose };
  // Why there is none, after NoPose; may be empty.
  [[nodiscard]] const std::string& why_none() const { return why_none_; }
  // Where its file cannot be read it counts as a pose: that there was one, its event says.
  Change follow(const SessionEvent& event) {
    const auto registration = read_(event);
    if (!registration) {
      pose_.reset();
      return Change::Pose;
    }
    if (!registration->has_pose) {
      pose_.reset();
      why_none_ = registration->reasons.empty() ? "" : registration->reasons.front();
      return Change::NoPose;
    }
    if (pose_ && is_same(*pose_, registration->marker_from_bone)) return Change::Verdict;
    pose_ = registration->marker_from_bone;
    return Change::Pose;
  }

 private:
  const ReadRegistration& read_;
  std::optional<geometry::RigidTransform> pose_;
  std::string why_none_;
};

}  // namespace

std::vector<ToldEvent> told_events(const std::vector<SessionEvent>& events, const ReadRegistration& read) {
  std::vector<ToldEvent> told;
  PoseFollower poses(read);
  bool was_registered = false;
  for (const SessionEvent& event : events) {
    ToldEvent& next = told.emplace_back();
    next.event = &event;
    const auto* const name =
        std::find_if(kNames.begin(), kNames.end(), [&](const Name& one) { return one.kind == event.kind; });
    next.words = name == kNames.end() ? event.kind : name->words;
    if (name == kNames.end() || !name->has_file) next.detail = event.text;
    if (name == kNames.end()) continue;
    next.gravity = name->gravity;
    next.is_of_operation = name->is_of_operation;
    if (event.kind == kAlarmEvent && event.text.empty()) {
      next.words = "alarm is over";
      next.gravity = Gravity::Step;
    }
    if (event.kind == kMarkerOutEvent && !event.text.empty()) next.words = "world marker not out";
    if (!is_registration(event)) continue;
    const PoseFollower::Change change = poses.follow(event);
    if (change == PoseFollower::Change::Verdict) {
      next.words = "registration judged anew";
      next.gravity = Gravity::Note;
      next.is_of_operation = false;
    } else if (change == PoseFollower::Change::NoPose) {
      next.words = was_registered ? "nothing is registered any more" : "no place of the bone was found";
      if (was_registered && !poses.why_none().empty()) next.words += ": " + poses.why_none();
    }
    was_registered = was_registered || change == PoseFollower::Change::Pose;
  }
  return told;
}

std::string clock_text(double seconds) {
  const long tenths = std::lround(10 * seconds);
  return files::format("%ld:%02ld.%ld", tenths / 600, tenths / 10 % 60, tenths % 10);
}

std::vector<PoseInForce> poses_in_force(const std::vector<SessionEvent>& events,
                                        const ReadRegistration& read) {
  std::vector<PoseInForce> poses;
  PoseFollower follower(read);
  bool is_in_force = false;
  const auto end = [&](const SessionEvent& event) {
    if (is_in_force) poses.back().until_frame = event.after_frame;
    is_in_force = false;
  };
  for (const SessionEvent& event : events) {
    if (event.kind == kVoidEvent) end(event);
    if (!is_registration(event)) continue;
    const PoseFollower::Change change = follower.follow(event);
    if (change == PoseFollower::Change::Verdict && is_in_force) {
      poses.back().files.push_back(event.text);
      continue;
    }
    end(event);
    if (change == PoseFollower::Change::NoPose) continue;
    poses.push_back({{event.text}, event.after_frame, std::nullopt});
    is_in_force = true;
  }
  return poses;
}

}  // namespace arthronaut::recording
