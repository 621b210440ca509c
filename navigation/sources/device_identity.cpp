#include "navigation/sources/device_identity.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

namespace arthronaut::sources {

namespace {

template <std::size_t Size>
std::string text_of(const __u8 (&bytes)[Size]) {
  const char* const begin = reinterpret_cast<const char*>(bytes);
  return {begin, ::strnlen(begin, Size)};
}

}  // namespace

std::optional<DeviceSays> ask_device(const std::filesystem::path& device) {
  const int file = ::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  v4l2_capability says{};
  const bool answers = ::ioctl(file, VIDIOC_QUERYCAP, &says) == 0;
  ::close(file);
  if (!answers) return std::nullopt;
  const bool tells_of_node = (says.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const __u32 can = tells_of_node ? says.device_caps : says.capabilities;
  const bool gives_pictures = (can & V4L2_CAP_VIDEO_CAPTURE) != 0;
  return DeviceSays{text_of(says.driver), text_of(says.card), text_of(says.bus_info), gives_pictures};
}

std::string device_identity(const std::filesystem::path& device, const std::filesystem::path& names,
                            const AskDevice& ask) {
  const std::optional<DeviceSays> says = ask(device);
  if (!says) return "";
  std::string identity = says->driver + ", " + says->card;
  // A USB camera's entry leads to one of its interfaces; the number is the whole device's.
  std::ifstream file(names / device.filename() / "device" / ".." / "serial");
  std::string serial;
  if (std::getline(file, serial) && !serial.empty()) return identity + ", serial " + serial;
  return identity + ", at " + says->bus;
}

}  // namespace arthronaut::sources
