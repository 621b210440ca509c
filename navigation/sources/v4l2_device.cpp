#include "navigation/sources/v4l2_device.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "navigation/sources/pixel_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

V4l2Device::V4l2Device(int index) : name_("camera " + std::to_string(index)) {
  file_ = ::open(("/dev/video" + std::to_string(index)).c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) throw DeviceError(name_ + ": " + device_words(errno));
  const auto refuse = [&](const std::string& why) {
    close();
    throw DeviceError(name_ + ": " + why);
  };
  if (request(VIDIOC_QUERYCAP, &says_) != 0) refuse("is no camera");
  // A camera has further nodes, for its metadata.
  const std::uint32_t can =
      (says_.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? says_.device_caps : says_.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) refuse("gives no pictures: another number of it does");
  if ((can & V4L2_CAP_STREAMING) == 0) refuse("its driver gives no pictures that can be mapped");
}

void V4l2Device::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

int V4l2Device::request(unsigned long what, void* with) const {
  for (;;) {
    if (::ioctl(file_, what, with) == 0) return 0;
    if (errno != EINTR) return errno;
  }
}

void V4l2Device::fail(const std::string& what, int error) const {
  throw DeviceError(name_ + ": " + (what.empty() ? "" : what + ": ") + device_words(error));
}

std::string device_words(int error) {
  switch (error) {
    case ENOENT:
      return "is not connected";
    case ENODEV:
    case ENXIO:
      return "was unplugged";
    case EBUSY:
      return "is in use by another program";
    case EACCES:
    case EPERM:
      return "this user may not read it: join the group \"video\"";
    case EIO:
      return "the device answers with an error: check its cable";
    case ENOSPC:
      return "there is no room for its pictures on the USB bus: plug it into another socket, or ask for less";
    case ENOLINK:
      return "has no signal";
    case ENOLCK:
      return "has a signal that does not stand still";
    default:
      return std::strerror(error);
  }
}

std::string driver_text(const unsigned char* bytes, std::size_t most) {
  const char* const begin = reinterpret_cast<const char*>(bytes);
  return {begin, ::strnlen(begin, most)};
}

std::string signal_trouble(const V4l2Device& device) {
  int index = 0;
  v4l2_input input{};
  if (device.request(VIDIOC_G_INPUT, &index) != 0) return "";
  input.index = static_cast<std::uint32_t>(index);
  if (device.request(VIDIOC_ENUMINPUT, &input) != 0) return "";
  if ((input.status & V4L2_IN_ST_NO_POWER) != 0) return "no power: the input is switched off";
  if ((input.status & V4L2_IN_ST_NO_SIGNAL) != 0)
    return "no signal: check the cable, and that the scope's tower is on";
  if ((input.status & (V4L2_IN_ST_NO_SYNC | V4L2_IN_ST_NO_H_LOCK)) != 0)
    return "a signal that does not stand still: check cable and format";
  return "";
}

double rate_of(const V4l2Device& device) {
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.request(VIDIOC_G_PARM, &rate) != 0) return 0;
  const v4l2_fract& interval = rate.parm.capture.timeperframe;
  if (interval.numerator == 0 || interval.denominator == 0) return 0;
  return static_cast<double>(interval.denominator) / interval.numerator;
}

v4l2_pix_format take_mode(const V4l2Device& device, const CameraMode& mode) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  // MJPEG has two numbers, and others have none: the driver's own counts.
  for (v4l2_fmtdesc one{};; ++one.index) {
    one.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.request(VIDIOC_ENUM_FMT, &one) != 0) break;
    if (format_name(one.pixelformat) == mode.format) {
      format.fmt.pix.pixelformat = one.pixelformat;
      break;
    }
  }
  const std::uint32_t wanted = format.fmt.pix.pixelformat;
  format.fmt.pix.width = static_cast<std::uint32_t>(mode.size_px.x());
  format.fmt.pix.height = static_cast<std::uint32_t>(mode.size_px.y());
  format.fmt.pix.field = V4L2_FIELD_ANY;
  if (const int error = device.request(VIDIOC_S_FMT, &format); error != 0) device.fail("", error);
  const v4l2_pix_format& given = format.fmt.pix;
  const CameraMode got{format_name(given.pixelformat),
                       {static_cast<int>(given.width), static_cast<int>(given.height)}};
  if (given.pixelformat != wanted || got.size_px != mode.size_px)
    throw DeviceError(device.name() + ": was asked for " + text_of(mode) + ", and gives " + text_of(got));
  if (given.field == V4L2_FIELD_TOP || given.field == V4L2_FIELD_BOTTOM ||
      given.field == V4L2_FIELD_ALTERNATE)
    throw DeviceError(device.name() + ": gives half pictures (fields), which are not put together");
  if (mode.frames_per_second > 0) {
    v4l2_streamparm rate{};
    rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    // In thousandths, in which 59.94 is no other rate than the driver's 60000/1001.
    rate.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(mode.frames_per_second * 1000 + 0.5)};
    // A driver whose rate is that of what is connected takes none.
    (void)device.request(VIDIOC_S_PARM, &rate);
  }
  return given;
}

}  // namespace arthronaut::sources
