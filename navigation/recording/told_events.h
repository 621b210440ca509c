// What happened in a session, event by event, as it is told to whoever looks at it later: by what name, and
// how grave it is. The one place that says so, for the report and for Review.
//
// Every change of verdict writes its registration anew: that an alarm began, or was over, is no bone that was
// registered. A registration is one by its pose.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

enum class Gravity {
  Step,   // it came to something: registered, verified, drilled
  Alarm,  // a warning, or something that became void
  Note,   // whatever else the record says
};

struct ToldEvent {
  const SessionEvent* event = nullptr;
  std::string words;   // "bone registered", "alarm is over"; of a kind that has no name of its own, the kind
  std::string detail;  // what the event itself says, for a person; often empty
  Gravity gravity = Gravity::Note;
  bool is_of_operation = false;  // a step of it, or what stood against one; not of the record or the source
};

// Of a registration event; nullopt where its file cannot be read.
using ReadRegistration =
    std::function<std::optional<registration::RegistrationSummary>(const SessionEvent& event)>;

// All of them, in their order; they point into `events`.
[[nodiscard]] std::vector<ToldEvent> told_events(const std::vector<SessionEvent>& events,
                                                 const ReadRegistration& read);

// A time of a session as it is told: "1:02.3".
[[nodiscard]] std::string clock_text(double seconds);

// A pose of the bone and how long it was in force, whatever the verdicts on it were.
struct PoseInForce {
  std::vector<std::string> files;           // of its registration events, the first verdict first
  std::int64_t after_frame = -1;            // it came after
  std::optional<std::int64_t> until_frame;  // the last one that it was in force in; nullopt: to the end
};
[[nodiscard]] std::vector<PoseInForce> poses_in_force(const std::vector<SessionEvent>& events,
                                                      const ReadRegistration& read);

}  // namespace arthronaut::recording
