#include "navigation/worker/freed_memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <thread>
#include <vector>

namespace arthronaut::worker {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long all = 0, resident = 0;
  statm >> all >> resident;
  return static_cast<double>(resident) * 4096e-6;
}

// A thread fills 40 MB in small pieces and frees all but the last, which keeps the allocator from trimming:
// half of it at least is the system's again.
TEST(FreedMemory, IsGivenBack) {
  constexpr std::size_t kPieces = 40'000, kBytes = 1000;
  std::vector<std::unique_ptr<char[]>> pieces(kPieces);
  std::thread([&] {
    for (auto& piece : pieces) piece = std::make_unique<char[]>(kBytes);
    for (std::size_t i = 0; i + 1 < kPieces; ++i) pieces[i].reset();
  }).join();
  const double before = resident_mb();
  give_freed_memory_back();
  EXPECT_LT(resident_mb(), before - 20);
}

}  // namespace
}  // namespace arthronaut::worker
