// Inner header: pictures that a camera has compressed one by one.
#pragma once

#include <cstdint>
#include <memory>

#include "navigation/sources/libav.h"

namespace arthronaut::sources {

class MotionJpeg {
 public:
  MotionJpeg();
  // The picture, until the next call; null when it is damaged or cut off.
  [[nodiscard]] const AVFrame* decode(const std::uint8_t* data, std::size_t byte_count);

 private:
  LibavPtr<AVCodecContext> decoder_;
  LibavPtr<AVPacket> packet_;
  LibavPtr<AVFrame> picture_;
};

}  // namespace arthronaut::sources
