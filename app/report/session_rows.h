// What a session says of itself in a report: where its pictures came from, and what stood against a mistake.
#pragma once

#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::report {

// The name of a recording's file is often the patient's: only of what kind it is. A camera, a stream and a
// simulation are called what they are.
[[nodiscard]] std::string neutral_source(const std::string& source);
// "live: a camera, as it came"; "not recorded".
[[nodiscard]] std::string kind_in_words(const recording::SessionHeader& header);
// Which tunnels of bundles the session guided to, in the order of time: "femur AM, femur PL"; empty where a
// bone's single one was.
[[nodiscard]] std::string guided_bundles(const recording::RecordedSession& session);
// What was asked before the guide was followed, and what spoke against it, as the session's events say it: a
// name and a text each.
[[nodiscard]] std::vector<std::vector<std::string>> safety_rows(const recording::RecordedSession& session);

}  // namespace arthronaut::report
