// What a frame was broken off by, said for some seconds: a file that cannot be read is a sentence on the
// screen, not the end of the workstation in the middle of an operation.
#pragma once

#include <string>

namespace arthronaut::window {

class FrameFault {
 public:
  // While it is said again in every frame it is logged once.
  void note(const std::string& what, double now_s);
  // Empty while nothing was noted for some seconds.
  [[nodiscard]] std::string words(double now_s) const;

 private:
  std::string what_;
  double noted_at_s_ = -1e9;
};

}  // namespace arthronaut::window
