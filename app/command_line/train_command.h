// Exercises on the simulator without a window: `arthronaut train`. Apart from command.h, which every other
// command includes.
#pragma once

#include "app/command_line/command.h"

namespace arthronaut::command_line {

void add_train_command(CLI::App& app, Context& context);

}  // namespace arthronaut::command_line
