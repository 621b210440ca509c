// What was wrong with the pictures of a live source while a session was recorded. Inner header of report.
#pragma once

#include <string>
#include <vector>

#include "navigation/recording/session.h"
#include "navigation/theatre/source_watch.h"

namespace arthronaut::report {

struct SourceFault {
  const recording::SessionEvent* event = nullptr;  // with which it was told first; of the session
  theatre::SourceTrouble trouble = theatre::SourceTrouble::None;
  double from_s = 0, for_s = 0;  // from the first picture
  // Nothing, or nothing of the knee, was seen meanwhile, or parts of two moments.
  [[nodiscard]] bool is_loss() const;
};

// In the order of time; what goes on by other words is one fault.
[[nodiscard]] std::vector<SourceFault> source_faults(const recording::RecordedSession& session);
// "no picture 3 times, 26.4 s in all; torn picture once, 2.1 s"; "none".
[[nodiscard]] std::string in_words(const std::vector<SourceFault>& faults);
// For how long a live source gave no picture: all gaps that are longer than a source's pause, and what was
// between its last picture and its end. 0 for other sources: theirs come when they are asked for.
[[nodiscard]] double without_picture_s(const recording::RecordedSession& session);

}  // namespace arthronaut::report
