// Counts what this test program allocates. In a file of its own: inlined operators confuse the compiler's
// warnings.
#pragma once

namespace arthronaut::test {

void start_counting_allocations();
[[nodiscard]] long stop_counting_allocations();

}  // namespace arthronaut::test
