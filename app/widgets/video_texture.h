// The live picture as an OpenGL texture. On the thread that owns the context.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::widgets {

class VideoTexture {
 public:
  VideoTexture() = default;
  ~VideoTexture();
  VideoTexture(const VideoTexture&) = delete;
  VideoTexture& operator=(const VideoTexture&) = delete;

  // Uploads a frame that is not the one uploaded last. Null is ignored.
  void upload(const camera::FramePtr& frame);
  [[nodiscard]] std::uint32_t texture() const { return texture_; }  // 0 before the first upload
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  std::uint32_t texture_ = 0;
  int width_ = 0, height_ = 0;
  camera::FramePtr uploaded_;
  std::vector<std::uint8_t> made_;  // its colours, of frames that keep none
};

}  // namespace arthronaut::widgets
