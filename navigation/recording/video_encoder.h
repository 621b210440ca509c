// One Ut Video stream in a Matroska file, picture by picture. PictureWriter gives it a thread.
//
// Luma is kept bit for bit: the plane that camera::gray_from() gives, in full range, so that tracking the
// file again gives the same poses. Colour is for the eye: half the resolution, in steps of four grey values.
// Every picture is a key frame. FFV1 takes four to five times the time and lossless H.264 twice, at 0.6 to
// 0.95 of the size (docs/benchmarks.md).
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/camera/frame.h"

namespace arthronaut::recording {

class VideoEncoder {
 public:
  // Throws IoError when the file cannot be created or this libavcodec has no Ut Video encoder.
  VideoEncoder(const std::filesystem::path& file, int width, int height, double frames_per_second);
  ~VideoEncoder();

  // Throws IoError, and InvalidInput for another size than the first.
  void encode(const camera::Frame& picture);
  // Writes what is left and the file's end. Throws IoError.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
