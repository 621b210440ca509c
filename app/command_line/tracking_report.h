// How well markers and lens were seen, in lines for the user: the same words in track, navigate and demo.
#pragma once

#include <string>

#include "app/command_line/command.h"
#include "navigation/pipeline/track_video.h"

namespace arthronaut::command_line {

void say_statistics(const Context& context, const pipeline::ViewStatistics& statistics);

// printf into a string.
[[nodiscard]] std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace arthronaut::command_line
