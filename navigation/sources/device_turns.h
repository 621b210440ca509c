// One reader a camera: a device is opened again only when the source that had it is gone. Every part of the
// program that opens devices shares one DeviceTurns; copies share their turns.
//
// Threads: open() may be called from any thread but the screen's, since it waits. A source gives its turn
// back when it is destroyed, on whatever thread that happens.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "navigation/sources/camera_device.h"
#include "navigation/sources/camera_modes.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

class DeviceTurns {
 public:
  using Opener = std::function<std::unique_ptr<FrameSource>(const CameraAddress& address)>;
  // Letting go of a device takes a picture or two, 5 s where a driver is slow.
  explicit DeviceTurns(Opener opener = open_camera, double patience_s = 5);

  // Waits while the device is still read, patience_s at most. Throws DeviceError when it is read on ("camera
  // 0 is in use"), and what the opener throws.
  [[nodiscard]] std::unique_ptr<FrameSource> open(const CameraAddress& address) const;
  // The same for who only looks: waits for nobody, and takes its turn from nobody who has it.
  [[nodiscard]] std::unique_ptr<FrameSource> open_if_free(const CameraAddress& address) const;
  // A stream, by open_stream(): a port that is listened on here cannot be listened on a second time. Who
  // still has it after patience_s is not told of: the stream's own error says what is wrong, and many streams
  // can be had twice.
  [[nodiscard]] std::unique_ptr<FrameSource> open_stream(const std::string& address) const;
  [[nodiscard]] std::unique_ptr<FrameSource> open_stream_if_free(const std::string& address) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace arthronaut::sources
