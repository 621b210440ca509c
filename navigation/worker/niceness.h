// How readily a thread stands back where there is more to do than the machine has cores.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace arthronaut::worker {

// The calling thread's niceness becomes so much greater, 19 at most; those that it starts take it over. On
// Linux a thread has one of its own. A system that does not let it be is no reason to fail.
inline void stand_back(int by) {
  const auto thread = static_cast<id_t>(::gettid());
  constexpr int kMost = 19;
  (void)::setpriority(PRIO_PROCESS, thread, std::min(::getpriority(PRIO_PROCESS, thread) + by, kMost));
}

}  // namespace arthronaut::worker
