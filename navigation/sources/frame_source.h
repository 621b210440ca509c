// Where pictures come from: a video file, still images, a camera device or the simulator, all alike.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

enum class SourceKind { Live, Recording, Simulation };

struct SourceInfo {
  std::string name;  // for screen and record
  Eigen::Vector2i image_size_px{0, 0};
  double frames_per_second = 0;   // 0 when unknown
  std::int64_t frame_count = -1;  // -1 when unknown or endless
  bool is_live = false;           // frames come at their own pace and can be missed
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
// number missing in between is refused), or one still image. Throws IoError or InvalidInput. Timestamps: the
// file's, else frame / fps, else frame / 60. Where the file's clock is too coarse for its constant frame rate
// (Matroska counts in ms), frame / fps. Colours are converted by the BT.601 matrix whatever the file is
// tagged with, as OpenCV does: the luma that camera::gray_from() computes is then the luma that was encoded.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::filesystem::path& video_or_pattern);
// Throws DeviceError.
[[nodiscard]] std::unique_ptr<FrameSource> open_device(int device_index);

// One still picture (PNG, JPEG and whatever else OpenCV reads) as a frame. Grey pictures become BGR, alpha is
// dropped; pictures of more than 8 bits and cut-off files are refused. Throws IoError or InvalidInput.
[[nodiscard]] camera::Frame read_picture(const std::filesystem::path& file);

}  // namespace arthronaut::sources
