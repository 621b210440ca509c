#include "app/review/freed_memory.h"

#include <malloc.h>

namespace arthronaut::review {

void give_freed_memory_back() { (void)::malloc_trim(0); }

}  // namespace arthronaut::review
