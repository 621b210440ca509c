// Which camera a V4L2 device is, as far as it says: so that another one in its place is not taken for it,
// with its calibration.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace arthronaut::sources {

struct DeviceSays {  // VIDIOC_QUERYCAP
  std::string driver, card, bus;
  bool gives_pictures = true;
};
using AskDevice = std::function<std::optional<DeviceSays>(const std::filesystem::path& device)>;
// Asks the driver; nullopt where there is none.
[[nodiscard]] std::optional<DeviceSays> ask_device(const std::filesystem::path& device);

// "uvcvideo, Capture card, serial 1234", wherever it is plugged in; of a camera that has no serial number,
// and cannot be told from another one of its model, "uvcvideo, Capture card, at usb-0000:00:14.0-1". Empty:
// nobody knows. The folder of the system's names and the question are given for tests alone.
[[nodiscard]] std::string device_identity(const std::filesystem::path& device,
                                          const std::filesystem::path& names = "/sys/class/video4linux",
                                          const AskDevice& ask = ask_device);

}  // namespace arthronaut::sources
