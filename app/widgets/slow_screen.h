// Says that the screen is too slow for what it is there for, by what its own frames take: fewer than 20
// pictures a second, and a key that is seen later than it should be. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace arthronaut::widgets {

class SlowScreen {
 public:
  static constexpr std::size_t kFrames = 40;                  // of which more than half decide
  static constexpr double kSlow_s = 0.05, kQuick_s = 0.0425;  // told above the one until below the other

  // A frame took so long from its beginning to the screen. `matters`: an operation runs; without one nothing
  // is counted, and nothing said.
  void drawn(double frame_s, bool matters);
  // "The screen is slow: 14 pictures a second"; empty when it is not.
  [[nodiscard]] std::string words() const;

 private:
  std::array<double, kFrames> took_s_{};
  std::size_t count_ = 0;
  double slow_s_ = 0;  // what a frame takes, while it is told; 0: it is not
};

}  // namespace arthronaut::widgets
