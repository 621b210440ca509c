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

// Where a decoder keeps a picture: its colours are made when somebody wants to see them, and never for
// tracking.
class PictureMemory {
 public:
  virtual ~PictureMemory() = default;
  // The picture's luma where it lies, as long as this lives; no data where it has to be made (Frame::luma).
  [[nodiscard]] virtual GrayView luma() const = 0;
  // Packed 8-bit BGR, 3 * width * height. From any thread, from several at once.
  virtual void bgr_into(std::vector<std::uint8_t>& bgr) const = 0;
};

// One picture of a source: 8-bit BGR as OpenCV decodes it, rows packed, or what it can be made of. Immutable
// once published. Whoever tracks asks luma_of(), whoever shows asks bgr_of().
struct Frame {
  std::int64_t index = 0;         // counts from 0 in its source
  std::int64_t timestamp_ns = 0;  // when it was grabbed; monotone within a source
  // The same moment on std::chrono::steady_clock, so that an age can be told; 0 when the source is not live.
  std::int64_t captured_ns = 0;
  CaptureClock capture_clock = CaptureClock::None;
  // Which of a stream's packets it was decoded from, counted from 0 over all connections; -1: of none. (A
  // year at 60 a second.)
  std::int32_t packet = -1;
  // On the same clock, of a live source: when its data had come, and when it could be looked at. 0: not said.
  std::int64_t received_ns = 0, decoded_ns = 0;
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;  // 3 * width * height; empty where `memory` makes them
  // width * height, when the source knows the luma better than its colours do (a recording that kept it
  // exactly, a stream); empty: it lies in `memory`, or is computed from the colours.
  std::vector<std::uint8_t> luma;
  std::shared_ptr<const PictureMemory> memory;  // null: bgr holds the colours
};
using FramePtr = std::shared_ptr<const Frame>;

// Luma of a frame: the frame's own, in place, where it has one; else BT.601 of its colours in `scratch`,
// which is resized once and then reused. What is tracked is this plane and nothing else. Valid as long as
// both.
[[nodiscard]] GrayView luma_of(const Frame& frame, std::vector<std::uint8_t>& scratch);
// The same, copied.
void gray_from(const Frame& frame, std::vector<std::uint8_t>& gray);
// Packed BGR of a frame: its own, else made into `scratch`. Valid as long as both.
[[nodiscard]] const std::vector<std::uint8_t>& bgr_of(const Frame& frame, std::vector<std::uint8_t>& scratch);

}  // namespace arthronaut::camera
