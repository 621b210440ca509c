// The cameras that are connected, and what they can give.
#pragma once

#include "app/command_line/command.h"

namespace arthronaut::command_line {

void add_sources_command(CLI::App& app, Context& context);

}  // namespace arthronaut::command_line
