// Whether a record ends before the operation did, and why.
#pragma once

#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

// What it says of itself: "the video stopped: no space left on device; the record was never finished". Empty:
// all of it is there. is_being_recorded (recording_lock.h): "it is being recorded now".
[[nodiscard]] std::string cut_short_in_words(bool was_finished, const std::vector<SessionEvent>& events,
                                             bool is_being_recorded = false);

}  // namespace arthronaut::recording
