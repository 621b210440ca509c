// Still images as a video of 60 frames a second.
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/sources/frame_source.h"
#include "navigation/sources/video_file.h"

namespace arthronaut::sources {

[[nodiscard]] bool is_printf_pattern(const std::filesystem::path& path);
// A pattern with one %d or %0Nd in its last part, or the path of one picture.
[[nodiscard]] std::unique_ptr<FrameSource> open_still_images(const std::filesystem::path& pattern);
// The same, any of them by its time. What cannot be read throws InvalidInput or IoError.
[[nodiscard]] std::unique_ptr<SeekableVideo> open_seekable_stills(const std::filesystem::path& pattern);

}  // namespace arthronaut::sources
