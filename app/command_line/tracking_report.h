// How well markers and lens were seen, in lines for the user: the same words in track, navigate and demo.
#pragma once

#include <string>

#include "app/command_line/command.h"
#include "navigation/pipeline/track_video.h"
#include "planning/files/format.h"

namespace arthronaut::command_line {

void say_statistics(const Context& context, const pipeline::ViewStatistics& statistics);

using files::format;

}  // namespace arthronaut::command_line
