#include "navigation/camera/frame.h"

#include <algorithm>

namespace arthronaut::camera {

GrayView luma_of(const Frame& frame, std::vector<std::uint8_t>& scratch) {
  const std::size_t count = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (frame.luma.size() == count) return {frame.luma.data(), frame.width, frame.height, frame.width};
  if (frame.memory != nullptr)
    if (const GrayView own = frame.memory->luma(); own.data != nullptr) return own;
  scratch.resize(count);
  const std::uint8_t* bgr = frame.bgr.data();
  // 0.114 B + 0.587 G + 0.299 R in 14-bit fixed point; a plain loop that the compiler vectorises.
  for (std::size_t i = 0; i < count; ++i, bgr += 3) {
    scratch[i] = static_cast<std::uint8_t>((1868u * bgr[0] + 9617u * bgr[1] + 4899u * bgr[2] + 8192u) >> 14);
  }
  return {scratch.data(), frame.width, frame.height, frame.width};
}

void gray_from(const Frame& frame, std::vector<std::uint8_t>& gray) {
  const GrayView luma = luma_of(frame, gray);
  if (luma.data == gray.data()) return;
  gray.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y)
    std::copy(luma.row(y), luma.row(y) + frame.width,
              gray.data() + static_cast<std::ptrdiff_t>(y) * frame.width);
}

const std::vector<std::uint8_t>& bgr_of(const Frame& frame, std::vector<std::uint8_t>& scratch) {
  if (!frame.bgr.empty() || frame.memory == nullptr) return frame.bgr;
  frame.memory->bgr_into(scratch);
  return scratch;
}

}  // namespace arthronaut::camera
