// A video file, decoded with libavformat and libavcodec.
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// What Frame::luma is.
enum class LumaOf {
  Colours,  // left empty: users compute it
  File,     // the file's own plane, which must be 8-bit 4:2:0 or 4:4:4 in full range
};

// See open_video() and open_video_with_exact_luma().
[[nodiscard]] std::unique_ptr<FrameSource> open_video_file(const std::filesystem::path& file, LumaOf luma);

}  // namespace arthronaut::sources
