// Inner header: a camera as the kernel has it (V4L2), and what can be asked of it without disturbing whoever
// reads its pictures.
#pragma once

#include <linux/videodev2.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "navigation/sources/camera_facts.h"
#include "navigation/sources/camera_modes.h"

namespace arthronaut::sources {

// An open file of /dev/videoN. Throws DeviceError with the reason in words: not connected, not allowed, no
// camera, no pictures that a program may map.
class V4l2Device {
 public:
  explicit V4l2Device(int index);
  ~V4l2Device() { close(); }
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }  // "camera 0"
  [[nodiscard]] const v4l2_capability& says() const { return says_; }
  [[nodiscard]] int file() const { return file_; }  // below 0: closed
  void close();
  // An ioctl; 0, or the error number.
  [[nodiscard]] int request(unsigned long what, void* with) const;
  // "camera 0: can't be started: Device or resource busy", with the words of a user where it has some.
  [[noreturn]] void fail(const std::string& what, int error) const;

 private:
  std::string name_;
  int file_ = -1;
  v4l2_capability says_{};
};

// The words for an error number that a device answers with.
[[nodiscard]] std::string device_words(int error);
// What a driver wrote, which need not end in a zero.
[[nodiscard]] std::string driver_text(const unsigned char* bytes, std::size_t most);

// All that the driver tells. Of sizes without end those in use are named, and the wished one.
[[nodiscard]] std::vector<CameraMode> modes_of(const V4l2Device& device, const CameraWish& wish = {});
[[nodiscard]] std::vector<CameraInput> inputs_of(const V4l2Device& device);
// Why the input in use can show nothing: "no signal: check the cable ..."; empty: it can, as far as the
// driver knows.
[[nodiscard]] std::string signal_trouble(const V4l2Device& device);

// Takes input, TV standard and the timings of a digital signal as wished, else as detected. Throws
// DeviceError.
void take_input(const V4l2Device& device, const CameraWish& wish);
// Takes the mode; what the driver made of it. Throws DeviceError when that is another one.
[[nodiscard]] v4l2_pix_format take_mode(const V4l2Device& device, const CameraMode& mode);
// As the driver has it now; 0: it does not say.
[[nodiscard]] double rate_of(const V4l2Device& device);

}  // namespace arthronaut::sources
