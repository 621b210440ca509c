// Encodes pictures to a Matroska file in a thread of its own, with the luma as it was tracked, bit for bit
// (see video_encoder.h). The file is readable up to the last half second when the program is killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "navigation/camera/frame.h"

namespace arthronaut::recording {

// Threads: one thread at a time calls it. States: writing -> finished.
class PictureWriter {
 public:
  // The encoder starts with the first picture, whose size all others must have.
  PictureWriter(const std::filesystem::path& file, double frames_per_second);
  ~PictureWriter();  // finish(); errors are then lost

  // Hands over to the encoder; waits while too many are waiting. Throws IoError when the encoder or the disk
  // failed, and InvalidInput for another size.
  void write(const camera::FramePtr& picture);
  // The same, but false at once when too many are waiting.
  [[nodiscard]] bool try_write(const camera::FramePtr& picture);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
