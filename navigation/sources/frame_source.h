// Where pictures come from: a video file, still images, a camera device or the simulator, all alike.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "navigation/camera/frame.h"
#include "navigation/sources/source_kind.h"

namespace arthronaut::sources {

struct SourceInfo {
  std::string name;  // for screen and record
  Eigen::Vector2i image_size_px{0, 0};
  double frames_per_second = 0;   // 0 when unknown
  std::int64_t frame_count = -1;  // -1 when unknown or endless
  SourceKind kind = SourceKind::Recording;
  [[nodiscard]] bool is_live() const { return kind == SourceKind::Live; }
  std::filesystem::path
      encoded_file;  // the video as it came, to be copied instead of encoded again; empty when there is none
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual const SourceInfo& info() const = 0;
  // The next frame; null at the end. Throws InvalidInput when a file ends half-way through a frame or cannot
  // be decoded (it names file and frame), DeviceError when a device is gone.
  [[nodiscard]] virtual camera::FramePtr next() = 0;
};

// A video file, or a printf pattern of still images ("f_%04d.png", counted from the first that exists; a
// number missing in between is refused), or one still image. Throws IoError or InvalidInput; a pipe, a device
// file and an address ("rtsp://...") are refused at once, with the reason, and never waited for. Timestamps:
// the file's, else frame / fps, else frame / 60. Where the file's clock is too coarse for its constant frame
// rate (Matroska counts in ms), frame / fps. Colours are converted by the BT.601 matrix whatever the file is
// tagged with, as OpenCV does: the luma that camera::gray_from() computes is then the luma that was encoded.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::filesystem::path& video_or_pattern);
// A video whose luma plane is, byte for byte, what was tracked when it was recorded: frames carry it as
// Frame::luma. Full range, as recording::VideoEncoder writes it.
[[nodiscard]] std::unique_ptr<FrameSource> open_video_with_exact_luma(const std::filesystem::path& video);
// Frames carry the time of their capture: the driver's (V4L2 stamps on the monotonic clock, which OpenCV
// passes on) where it is one that can be true, else the moment the driver handed the picture over. Throws
// DeviceError.
[[nodiscard]] std::unique_ptr<FrameSource> open_device(int device_index);

// One still picture (PNG, JPEG, BMP, TIFF, WebP, PNM) as a frame. Grey pictures become BGR, alpha is dropped;
// pictures of more than 8 bits, cut-off files and pictures whose header claims more than 64 million pixels
// are refused, the last before anything is decoded. Throws IoError or InvalidInput.
[[nodiscard]] camera::Frame read_picture(const std::filesystem::path& file);

}  // namespace arthronaut::sources
