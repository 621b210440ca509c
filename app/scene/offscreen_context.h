// An OpenGL 3.3 core context without a window or a display (EGL, surfaceless), for pictures and tests.
#pragma once

#include <memory>

namespace arthronaut::scene {

class OffscreenContext {
 public:
  // Makes itself current on this thread. Throws DeviceError when the machine has no EGL or no OpenGL.
  OffscreenContext();
  ~OffscreenContext();  // the context that was current before is current again
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  void make_current() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::scene
