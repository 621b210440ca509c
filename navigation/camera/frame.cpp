#include "navigation/camera/frame.h"

#include <algorithm>

namespace arthronaut::camera {

void gray_from(const Frame& frame, std::vector<std::uint8_t>& gray) {
  const std::size_t count = static_cast<std::size_t>(frame.width) * frame.height;
  gray.resize(count);
  if (frame.luma.size() == count) {
    std::copy(frame.luma.begin(), frame.luma.end(), gray.begin());
    return;
  }
  const std::uint8_t* bgr = frame.bgr.data();
  // 0.114 B + 0.587 G + 0.299 R in 14-bit fixed point; a plain loop that the compiler vectorises.
  for (std::size_t i = 0; i < count; ++i, bgr += 3) {
    gray[i] = static_cast<std::uint8_t>((1868u * bgr[0] + 9617u * bgr[1] + 4899u * bgr[2] + 8192u) >> 14);
  }
}

}  // namespace arthronaut::camera
