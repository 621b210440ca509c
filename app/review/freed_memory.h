// Memory that a large job has freed, given back to the system.
#pragma once

namespace arthronaut::review {

// The allocator keeps what threads have freed, for them alone: after a comparison with a CT some 65 MB that
// nobody uses. Takes some milliseconds; for the end of a job, not for every frame.
void give_freed_memory_back();

}  // namespace arthronaut::review
