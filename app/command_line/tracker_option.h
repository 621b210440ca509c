// The option --tracker: who sees bones and tools in the place of the arthroscope.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "app/command_line/command.h"
#include "navigation/theatre/navigate_source.h"

namespace arthronaut::command_line {

void add_tracker_option(CLI::App& subcommand, std::string& address);

// The tracker that was given, else the one that the tools name, if any, into the tools. Throws InvalidInput
// where nobody says its address or it is none, and for pictures that are not live: they show what was.
void use_tracker(const std::string& given, const std::filesystem::path& tools_file, const std::string& video,
                 tools::ToolSet& tools);
// What listens to the tracker of options.source; says which it is, and what is missing for it to guide.
void listen_to_tracker(const Context& context, theatre::NavigateOptions& options);

}  // namespace arthronaut::command_line
