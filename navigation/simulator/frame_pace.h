// When the next picture of a scene in somebody's hands is due. Inner header of the simulator.
#pragma once

#include <chrono>
#include <optional>
#include <thread>

namespace arthronaut::simulator {

class FramePace {
 public:
  FramePace(int frames_per_second, bool in_real_time)
      : period_s_(1.0 / frames_per_second), in_real_time_(in_real_time) {}

  // Waits until then; how long after the picture before, s. In real time by the clock, so that a picture that
  // took long makes the hand go on by as much; else the same each time, at once.
  [[nodiscard]] double next_s() {
    if (!in_real_time_) return period_s_;
    if (!began_) began_ = Clock::now();
    std::this_thread::sleep_until(*began_ + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(at_s_ + period_s_)));
    const double step_s = std::chrono::duration<double>(Clock::now() - *began_).count() - at_s_;
    at_s_ += step_s;
    return step_s;
  }
  // What passed without the scene: no picture is late for it.
  void leave_out(double passed_s) {
    if (began_ && passed_s > 0)
      *began_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(passed_s));
  }

 private:
  using Clock = std::chrono::steady_clock;
  double period_s_;
  bool in_real_time_;
  std::optional<Clock::time_point> began_;
  double at_s_ = 0;
};

}  // namespace arthronaut::simulator
