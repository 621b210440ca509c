// `arthronaut experiment predicted-error`.
#pragma once

#include "app/command_line/command.h"

namespace arthronaut::command_line {

// Adds itself under `experiment`.
void add_predicted_error_experiment(CLI::App& experiment, Context& context);

}  // namespace arthronaut::command_line
