// Splits rows between two threads. Each row's result must not depend on any other, so that the picture is the
// same however it is split.
#pragma once

#include <thread>

namespace arthronaut::simulator {

// work(first_row, end_row). Returns when both halves are done. The work must not throw.
template <class Work>
void parallel_rows(int rows, Work work) {
  std::jthread upper([&] { work(0, rows / 2); });
  work(rows / 2, rows);
}

}  // namespace arthronaut::simulator
