// `arthronaut experiment lens-rotation`.
#pragma once

#include "app/command_line/command.h"

namespace arthronaut::command_line {

// Adds itself under `experiment`.
void add_lens_rotation_experiment(CLI::App& experiment, Context& context);

}  // namespace arthronaut::command_line
