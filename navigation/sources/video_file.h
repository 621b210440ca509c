// A video file, decoded with libavformat and libavcodec.
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// See open_video().
[[nodiscard]] std::unique_ptr<FrameSource> open_video_file(const std::filesystem::path& file);

}  // namespace arthronaut::sources
