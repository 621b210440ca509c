// Ctrl+C during work that must not end halfway.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace arthronaut::command_line {

// While it lives, Ctrl+C and requests to end are noted down instead of ending the program halfway.
class Interruption {
 public:
  Interruption() {
    signal_ = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      before_[i] = std::signal(kSignals[i], [](int caught) { signal_ = caught; });
      if (before_[i] == SIG_IGN) std::signal(kSignals[i], SIG_IGN);  // as under nohup
    }
  }
  ~Interruption() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) std::signal(kSignals[i], before_[i]);
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  // The signal; 0 while there was none.
  [[nodiscard]] int caught() const { return signal_; }
  // What the signal would have done at once.
  void end_program() const {
    std::signal(signal_, SIG_DFL);
    std::raise(signal_);
  }

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  static inline volatile std::sig_atomic_t signal_ = 0;
  std::array<void (*)(int), kSignals.size()> before_{};
};

}  // namespace arthronaut::command_line
