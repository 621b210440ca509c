// Memory that a large job has freed, given back to the system.
#pragma once

#include <malloc.h>

namespace arthronaut::worker {

// The allocator keeps what threads have freed, for them alone: after a session of two hours was looked into
// for what can be resumed some 200 MB that nobody uses. Takes some milliseconds; for the end of a job, not
// for every frame.
inline void give_freed_memory_back() { (void)::malloc_trim(0); }

}  // namespace arthronaut::worker
