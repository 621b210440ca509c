// Numbers by seed, the same on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace arthronaut::hard_clips {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1.0p-53;
  }
  [[nodiscard]] int below(int count) { return static_cast<int>(between(0, count)); }
  [[nodiscard]] bool happens(double share) { return between(0, 1) < share; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace arthronaut::hard_clips
