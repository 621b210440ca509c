// Whether a process of this machine lives, by its number: files that carry one belong to it.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <cerrno>

namespace arthronaut::files {

// Also as another user's. The number may be another process's by now.
[[nodiscard]] inline bool is_running(pid_t process) {
  return process > 0 && (::kill(process, 0) == 0 || errno != ESRCH);
}

}  // namespace arthronaut::files
