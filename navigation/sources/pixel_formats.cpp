#include "navigation/sources/pixel_formats.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>

namespace arthronaut::sources {

namespace {

// A luma plane of its own first, then packed luma, then colours of which luma must be made, then a picture
// without colours, which the surgeon would miss, then what is compressed.
constexpr std::array kFormats{
    PixelFormat{V4L2_PIX_FMT_NV12, "nv12", AV_PIX_FMT_NV12},
    PixelFormat{V4L2_PIX_FMT_YUV420, "yu12", AV_PIX_FMT_YUV420P},
    PixelFormat{V4L2_PIX_FMT_P010, "p010", AV_PIX_FMT_P010LE},
    PixelFormat{V4L2_PIX_FMT_YUYV, "yuyv", AV_PIX_FMT_YUYV422},
    PixelFormat{V4L2_PIX_FMT_UYVY, "uyvy", AV_PIX_FMT_UYVY422},
    PixelFormat{V4L2_PIX_FMT_BGR24, "bgr24", AV_PIX_FMT_BGR24},
    PixelFormat{V4L2_PIX_FMT_RGB24, "rgb24", AV_PIX_FMT_RGB24},
    PixelFormat{V4L2_PIX_FMT_GREY, "grey", AV_PIX_FMT_GRAY8},
    PixelFormat{V4L2_PIX_FMT_MJPEG, "mjpeg", AV_PIX_FMT_NONE, true},
    PixelFormat{V4L2_PIX_FMT_JPEG, "mjpeg", AV_PIX_FMT_NONE, true},
};

}  // namespace

std::span<const PixelFormat> pixel_formats() { return kFormats; }

const PixelFormat* find_pixel_format(std::uint32_t fourcc) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                         [&](const PixelFormat& one) { return one.fourcc == fourcc; });
  return found != kFormats.end() ? found : nullptr;
}

const PixelFormat* find_pixel_format(std::string_view name) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                         [&](const PixelFormat& one) { return one.name == name; });
  return found != kFormats.end() ? found : nullptr;
}

std::string format_name(std::uint32_t fourcc) {
  if (const PixelFormat* const known = find_pixel_format(fourcc)) return std::string(known->name);
  std::string letters;
  for (int i = 0; i < 4; ++i) {
    const char letter = static_cast<char>((fourcc >> (8 * i)) & 0x7F);
    if (letter > ' ') letters += letter;
  }
  return letters;
}

}  // namespace arthronaut::sources
