#include "navigation/sources/frame_source.h"

#include <algorithm>
#include <cctype>

#include "navigation/sources/camera_device.h"
#include "navigation/sources/camera_modes.h"
#include "navigation/sources/gstreamer_pipeline.h"
#include "navigation/sources/libav.h"
#include "navigation/sources/logged_source.h"
#include "navigation/sources/network_stream.h"
#include "navigation/sources/source_files.h"
#include "navigation/sources/still_images.h"
#include "navigation/sources/video_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPipeline = "gst:";

// "rtsp://10.0.0.5/scope": a name, a colon and two slashes.
bool is_address(std::string_view text) {
  const std::size_t colon = text.find("://");
  if (colon == std::string_view::npos || colon < 2) return false;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

// Reading a pipe waits until somebody writes into it, which may be never.
void refuse_what_is_no_file(const fs::path& path) {
  const fs::file_type type = fs::status(path).type();
  if (type == fs::file_type::regular) return;
  const char* reason = "is no file";
  if (type == fs::file_type::directory)
    reason = "is a folder; give a video or a pattern such as f_%04d.png";
  else if (type == fs::file_type::fifo)
    reason = "is a pipe; give a video file or the number of a camera";
  else if (type == fs::file_type::socket)
    reason = "is a socket; give a video file or the number of a camera";
  else if (type == fs::file_type::character || type == fs::file_type::block)
    reason = "is a device; give the number of a camera";
  throw InvalidInput(path, "", reason);
}

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::filesystem::path& video_or_pattern) {
  // A file of that very name wins over its reading as a pattern.
  if (!std::filesystem::exists(video_or_pattern)) {
    if (is_printf_pattern(video_or_pattern)) return logged(open_still_images(video_or_pattern));
    if (is_stream_address(video_or_pattern.string())) {
      throw InvalidInput(
          shown_address(video_or_pattern.string()), "",
          "is a stream, and this needs a recording, which can be read again: give a video file");
    }
    throw IoError(video_or_pattern, "no such file");
  }
  refuse_what_is_no_file(video_or_pattern);
  if (looks_like_picture(video_or_pattern)) return logged(open_still_images(video_or_pattern));
  return logged(open_video_file(video_or_pattern, LumaOf::Colours));
}

bool is_stream_address(std::string_view text) {
  return is_address(text) || with_small_scheme(std::string(text)).starts_with(kPipeline);
}

std::string with_small_scheme(std::string address) {
  const std::size_t end = is_address(address) ? address.find("://") : kPipeline.size();
  std::string small = address;
  for (std::size_t i = 0; i < std::min(end, small.size()); ++i)
    small[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(small[i])));
  return is_address(address) || small.starts_with(kPipeline) ? small : address;
}

std::string why_no_stream(const std::string& address) {
  const std::string small = with_small_scheme(address);
  return small.starts_with(kPipeline) ? "" : why_no_address(small);
}

std::unique_ptr<FrameSource> open_stream(const std::string& named) {
  const std::string address = with_small_scheme(named);
  if (address.starts_with(kPipeline))
    return logged(open_gstreamer_pipeline(address.substr(kPipeline.size())));
  return logged(open_network_stream(address));
}

SourceKind kind_of_source(std::string_view name) {
  return is_camera_address(name) || is_stream_address(name) ? SourceKind::Live : SourceKind::Recording;
}

std::unique_ptr<FrameSource> open_source(const std::string& name) {
  if (is_camera_address(name)) return open_camera(read_camera_address(name));
  if (is_stream_address(name)) return open_stream(name);
  return open_video(name);
}

std::unique_ptr<FrameSource> open_video_with_exact_luma(const std::filesystem::path& video) {
  if (!fs::exists(video)) throw IoError(video, "no such file");
  refuse_what_is_no_file(video);
  return logged(open_video_file(video, LumaOf::File));
}

}  // namespace arthronaut::sources
