// Runs the real executable, as a user does, in a folder of its own.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace arthronaut::test {

struct ProgramResult {
  int exit_code = -1;  // 128 + signal when it was killed
  std::string output, errors;
};

struct ProgramLimits {
  long file_size_bytes = 0;  // above 0: writing more fails like a full disk
  bool as_nobody = false;    // gives up root, which no folder is read-only for
  // What the program takes for the user's data (XDG_DATA_HOME); empty: a folder of this run's own.
  std::filesystem::path data_home = {};
  // Ctrl+C once this is true; asked all the while.
  std::function<bool()> interrupts_when = {};
  int interrupted_by = SIGINT;  // SIGKILL: it is given no time to tidy up
  // Standard error is a terminal: progress is shown.
  bool errors_on_terminal = false;
  std::filesystem::path output = {};  // where standard output goes in place of ProgramResult::output
};

ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramLimits& limits = {});

void write_file(const std::filesystem::path& file, const std::string& contents);

}  // namespace arthronaut::test
