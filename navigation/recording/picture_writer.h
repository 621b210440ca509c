// Encodes pictures to a Matroska file in a thread of its own. H.264, constant quality 10 (fastest preset, no
// delay): on path-traced arthroscopy at 1080p 0.12 MB a frame; the pose of a 4 mm marker then moves by 0.007
// mm and 0.07 deg at most. The file is readable up to the last half second when the program is killed.
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
