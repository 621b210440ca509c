// How well markers and lens were seen, and by which camera, in lines for the user: the same words in track,
// navigate and demo.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "navigation/pipeline/track_video.h"
#include "navigation/theatre/navigate_source.h"
#include "planning/files/format.h"

namespace arthronaut::command_line {

// Why the camera of this file, which is tracked with, is not reliable, where the file says so: nor then is
// what was seen by it.
[[nodiscard]] std::vector<std::string> camera_doubts(const std::filesystem::path& camera_file);
// Whether the camera of this file is of the simulated arthroscope. Nobody can tell whether the pictures are
// of it, too: what that means else is said on standard error, also to those who want no more than errors.
bool warn_of_simulated_camera(const std::filesystem::path& camera_file);
void say_statistics(const Context& context, const pipeline::ViewStatistics& statistics);

// Why what was recorded is not all there was to record; empty where it is.
[[nodiscard]] std::vector<std::string> record_reasons(const theatre::NavigationSummary& summary);

using files::format;

}  // namespace arthronaut::command_line
