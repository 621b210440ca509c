// Splits rows between the processor's cores. Each row's result must not depend on any other, so that the
// picture is the same however it is split.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace arthronaut::simulator {

inline constexpr int kBandRows = 32;
inline constexpr int kMostThreads = 4;  // more would take from what tracks the picture beside this

// work(first_row, end_row, thread), in bands of kBandRows that the threads take one after the other: what is
// drawn is seldom spread evenly over the picture. thread: below kMostThreads, of whom works. Returns when all
// is done. The work must not throw.
template <class Work>
void parallel_bands(int rows, Work work) {
  const int bands = (rows + kBandRows - 1) / kBandRows;
  std::atomic<int> next_band{0};
  const auto take_bands = [&](int thread) {
    for (int band = next_band++; band < bands; band = next_band++) {
      work(band * kBandRows, std::min(rows, (band + 1) * kBandRows), thread);
    }
  };
  const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostThreads);
  std::vector<std::jthread> helpers;
  for (int i = 1; i < std::min(threads, bands); ++i) helpers.emplace_back(take_bands, i);
  take_bands(0);
}

// The same for work(first_row, end_row).
template <class Work>
void parallel_rows(int rows, Work work) {
  parallel_bands(rows, [&work](int first, int end, int) { work(first, end); });
}

}  // namespace arthronaut::simulator
