// Pictures of the screen as H.264: into a Matroska file, or as MPEG-TS to "udp://HOST:PORT". For the eye
// alone: what is measured is never read from it.
//
// Each picture bears the time at which it was shown, so that a screen that stands still costs nothing. A
// window that changes its size goes on in the first one's. A picture of 1920 x 1080 takes 12 ms of one
// core (docs/benchmarks.md).
#pragma once

#include <memory>
#include <string>

#include "app/widgets/screen_picture.h"

namespace arthronaut::screen_copy {

// One that is sent, not written.
[[nodiscard]] bool is_stream(const std::string& target);

class ScreenEncoder {
 public:
  // A file is FILE.part until finish(), then FILE. Throws IoError when it cannot be begun or this libavcodec
  // has no H.264 encoder.
  ScreenEncoder(const std::string& target, int width, int height);
  // One that was not finished leaves FILE.part, which can be played up to its last second.
  ~ScreenEncoder();
  ScreenEncoder(const ScreenEncoder&) = delete;
  ScreenEncoder& operator=(const ScreenEncoder&) = delete;

  // In order of time; one that is not later than the one before is left out. Throws IoError.
  void encode(const widgets::ScreenPicture& picture);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::screen_copy
