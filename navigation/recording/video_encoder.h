// Pictures encoded to a Matroska file, one by one. PictureWriter gives it a thread.
//
// Lossless, by Ut Video: luma is kept bit for bit: the plane that camera::gray_from() gives, in full range,
// so that tracking the file again gives the same poses. Colour is for the eye: half the resolution, in steps
// of four grey values. Every picture is a key frame. FFV1 takes four to five times the time and lossless
// H.264 twice, at 0.6 to 0.95 of the size (docs/benchmarks.md).
//
// H.264, by the graphics processor where it can (VA-API), else by libx264: a key frame every half second, no
// picture waits for another one. Luma comes back with errors of some grey values: poses tracked again differ.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "navigation/camera/frame.h"
#include "navigation/recording/kept_video.h"

namespace arthronaut::recording {

// How coarse, on libx264's scale of rate factors: at the first poses that are tracked again differ by some
// thousandths of a millimetre; the other is for the eye alone, at a ninth of the bytes.
enum class H264For { Tracking = 10, Looking = 26 };

class VideoEncoder {
 public:
  // `as`: Lossless or H264; h264_for: of the latter. Throws IoError when the file cannot be created or this
  // libavcodec has no encoder.
  VideoEncoder(const std::filesystem::path& file, int width, int height, double frames_per_second,
               PicturesAs as = PicturesAs::Lossless, H264For h264_for = H264For::Tracking);
  ~VideoEncoder();

  // Throws IoError, and InvalidInput for another size than the first.
  void encode(const camera::Frame& picture);
  // Writes what is left and the file's end. Throws IoError.
  void finish();
  // libavcodec's name of the encoder: "utvideo", "libx264", "h264_vaapi".
  [[nodiscard]] std::string codec() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
