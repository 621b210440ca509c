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

// When a picture was taken is known to whom. Neither is the moment of the exposure: a USB camera's driver
// stamps the first data of a picture, after it was exposed and read out.
enum class CaptureClock {
  None,        // not live: there is no age to speak of
  HandedOver,  // the moment the picture left the driver; whatever it waited there is not seen
  Driver,      // the driver's own stamp
  Network,     // when its data came over the network; what sender and network took is not seen
};

// One picture of a source: 8-bit BGR as OpenCV decodes it, rows packed. Immutable once published.
struct Frame {
  std::int64_t index = 0;         // counts from 0 in its source
  std::int64_t timestamp_ns = 0;  // when it was grabbed; monotone within a source
  // The same moment on std::chrono::steady_clock, so that an age can be told; 0 when the source is not live.
  std::int64_t captured_ns = 0;
  CaptureClock capture_clock = CaptureClock::None;
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;  // 3 * width * height
  // width * height, when the source knows the luma better than its colours do (a recording that kept it
  // exactly); empty: it is computed from the colours.
  std::vector<std::uint8_t> luma;
};
using FramePtr = std::shared_ptr<const Frame>;

// Luma of a frame into caller-owned memory, which is resized once and then reused: the frame's own where it
// has one, else BT.601 of its colours. What is tracked is this plane and nothing else.
void gray_from(const Frame& frame, std::vector<std::uint8_t>& gray);

}  // namespace arthronaut::camera
