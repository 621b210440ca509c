// A command of this program, run in a process of its own: what draws off the screen cannot be done by a
// thread beside the window's.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace arthronaut::own_process {

struct CommandOutcome {
  // Unreliable: done, with doubts. Failed: nothing is left of what it was to write as one file. Stopped:
  // something unfinished may lie beside it, under a name that begins with a dot; of a folder the caller
  // knows.
  enum class End { Done, Unreliable, Failed, Stopped } end = End::Failed;
  std::string words;  // its doubts, or why it failed; may be empty
};

// Blocks; `stops` is asked again and again, and true kills the process. log: a file for what it says, in a
// folder that is there; it is removed when the process has ended. Throws IoError where it cannot be started.
[[nodiscard]] CommandOutcome run_command(const std::filesystem::path& program,
                                         std::vector<std::string> arguments, const std::filesystem::path& log,
                                         const std::function<bool()>& stops);

}  // namespace arthronaut::own_process
