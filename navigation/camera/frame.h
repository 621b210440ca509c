// Pictures as they travel through the program: plain memory, no library's type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace arthronaut::camera {

// Somebody else's 8-bit grey picture. Rows are stride bytes apart.
struct GrayView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;
  std::ptrdiff_t stride = 0;
  [[nodiscard]] const std::uint8_t* row(int y) const { return data + y * stride; }
};

// One picture of a source: 8-bit BGR as OpenCV decodes it, rows packed. Immutable once published.
struct Frame {
  std::int64_t index = 0;         // counts from 0 in its source
  std::int64_t timestamp_ns = 0;  // when it was grabbed; monotone within a source
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;  // 3 * width * height
};
using FramePtr = std::shared_ptr<const Frame>;

// Luma (BT.601) of a frame into caller-owned memory, which is resized once and then reused.
void gray_from(const Frame& frame, std::vector<std::uint8_t>& gray);

}  // namespace arthronaut::camera
