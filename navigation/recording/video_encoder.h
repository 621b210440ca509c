// One H.264 stream in a Matroska file, picture by picture. PictureWriter gives it a thread.
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/camera/frame.h"

namespace arthronaut::recording {

class VideoEncoder {
 public:
  // Throws IoError when the file cannot be created or this libavcodec has no H.264 encoder.
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
