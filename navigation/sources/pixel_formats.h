// Inner header: the pixel formats of cameras that can be read, as V4L2, libav and a user call them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

extern "C" {
#include <libavutil/pixfmt.h>
}

namespace arthronaut::sources {

struct PixelFormat {
  std::uint32_t fourcc = 0;  // V4L2_PIX_FMT_...
  std::string_view name;     // "yuyv"
  AVPixelFormat libav = AV_PIX_FMT_NONE;
  bool is_compressed = false;
};

// What costs least to read comes first.
[[nodiscard]] std::span<const PixelFormat> pixel_formats();
// Null: can't be read.
[[nodiscard]] const PixelFormat* find_pixel_format(std::uint32_t fourcc);
[[nodiscard]] const PixelFormat* find_pixel_format(std::string_view name);
// The name, else the four characters.
[[nodiscard]] std::string format_name(std::uint32_t fourcc);

}  // namespace arthronaut::sources
