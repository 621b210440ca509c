#include "navigation/sources/frame_source.h"

#include "navigation/sources/source_files.h"
#include "navigation/sources/still_images.h"
#include "navigation/sources/video_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

std::unique_ptr<FrameSource> open_video(const std::filesystem::path& video_or_pattern) {
  // A file of that very name wins over its reading as a pattern.
  if (!std::filesystem::exists(video_or_pattern)) {
    if (is_printf_pattern(video_or_pattern)) return open_still_images(video_or_pattern);
    throw IoError(video_or_pattern, "no such file");
  }
  if (std::filesystem::is_directory(video_or_pattern)) {
    throw InvalidInput(video_or_pattern, "", "is a folder; give a video or a pattern such as f_%04d.png");
  }
  if (looks_like_picture(video_or_pattern)) return open_still_images(video_or_pattern);
  return open_video_file(video_or_pattern);
}

}  // namespace arthronaut::sources
