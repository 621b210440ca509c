// The whole operation on the phantom knee and the simulated arthroscope, from plan to report, step by step.
#pragma once

#include <filesystem>

#include "app/command_line/command.h"
#include "navigation/simulator/surroundings.h"
#include "planning/bones/bone.h"

namespace arthronaut::command_line {

struct DemoOptions {
  std::filesystem::path case_folder;  // not there yet
  std::uint64_t seed = 1;
  bones::Side side = bones::Side::Right;
  simulator::SurroundingsOptions surroundings = {};
};

// Says each step with its numbers, and those against the truth of the simulation. Sets the exit code to 4,
// with the reasons, when a step is not reliable. When it throws, or is stopped by Ctrl+C, the case folder is
// gone again.
void run_demo(Context& context, const DemoOptions& options);

}  // namespace arthronaut::command_line
