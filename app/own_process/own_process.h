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

// What goes on, and how much of the whole is done, 0 to 1.
using OnProgress = std::function<void(const std::string& what, double share)>;

// Blocks; `stops` is asked again and again, and true kills the process: Stopped, unless
// it had come to its end just then, which is told as it was. log: a file for what it says, in a
// folder that is there; it is removed when the process has ended. on_progress: where it is given, the command
// gets "--progress-fd 3" and writes lines there, see tell_progress(). Throws IoError where it cannot be
// started.
[[nodiscard]] CommandOutcome run_command(const std::filesystem::path& program,
                                         std::vector<std::string> arguments, const std::filesystem::path& log,
                                         const std::function<bool()>& stops,
                                         const OnProgress& on_progress = {});

// In the process that was started: "0.250 Drawing the plan", a line each. Without effect where nobody reads.
void tell_progress(int descriptor, const std::string& what, double share);

}  // namespace arthronaut::own_process
