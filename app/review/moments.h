// What happened in a session, in words and each at its frame: every command that was given, every step that
// was taken, every alarm. Plain functions, no window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "navigation/recording/session_marks.h"
#include "navigation/recording/session_timeline.h"
#include "navigation/recording/told_events.h"

namespace arthronaut::review {

enum class MomentKind {
  Command,  // somebody asked for it: a press, a script
  Step,     // it came to something: registered, verified, drilled
  Alarm,    // a warning, or something that became void
  Note,     // whatever else the record says
};

struct Moment {
  std::size_t frame = 0;  // of SessionTimeline::frames()
  MomentKind kind = MomentKind::Note;
  std::string words;  // "Asked for: take touch", "Alarm: the marker has moved"
  // Seconds from the first frame, as the report says it: after the last picture, that of the record's clock.
  // Of a session without frames, from the first event that has a time.
  double time_s = 0;
};

// In the order of the record. What the record holds for running it again alone (outcomes, second looks) is
// left out, and so is a plan that was in force already. Without frames every `frame` is 0.
[[nodiscard]] std::vector<Moment> moments_of(const std::vector<recording::SessionEvent>& events,
                                             const recording::SessionTimeline& timeline,
                                             const recording::ReadRegistration& read);

// What happened at that frame, or last before it; behind the last picture with its own time, which the cursor
// does not show: "0:09.7, after the pictures: Tunnel drilled". Empty: nothing did. Preconditions: the
// timeline has frames.
[[nodiscard]] std::string last_moment_in_words(const std::vector<Moment>& moments,
                                               const recording::SessionTimeline& timeline, std::size_t frame);

// The nearest frame before or after `frame` at which something happened or a mark stands; nullopt: none.
[[nodiscard]] std::optional<std::size_t> moment_before(const std::vector<std::size_t>& frames,
                                                       std::size_t frame);
[[nodiscard]] std::optional<std::size_t> moment_after(const std::vector<std::size_t>& frames,
                                                      std::size_t frame);
// The frames of both, rising, each once.
[[nodiscard]] std::vector<std::size_t> frames_to_jump_to(const std::vector<Moment>& moments,
                                                         const recording::SessionMarks& marks,
                                                         const recording::SessionTimeline& timeline);

}  // namespace arthronaut::review
