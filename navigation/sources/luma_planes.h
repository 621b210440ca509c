// The luma of a picture as drivers and decoders lay it out, brought to 8 bits and all 256 steps: what
// camera::gray_from() would compute of its colours, without their detour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

struct LumaPlane {
  const std::uint8_t* data = nullptr;  // of the first pixel's luma; null: there is none
  std::ptrdiff_t stride = 0;           // bytes from row to row
  int step = 1;                        // bytes from pixel to pixel: 1 planar, 2 YUYV, 2 with more than 8 bits
  int bits = 8, shift = 0;             // of a sample; little-endian, `shift` bits above the lowest
  bool is_full_range = false;          // else 16 to 235 (of 8 bits)
  int width = 0, height = 0;

  // Where it lies, when it is what is wanted already; else no data.
  [[nodiscard]] camera::GrayView in_place() const {
    if (data == nullptr || step != 1 || bits != 8 || !is_full_range) return {};
    return {data, width, height, stride};
  }
  // Packed. Resized once, then reused.
  void write(std::vector<std::uint8_t>& luma) const;
};

// A frame's luma left where it lies in the memory's picture, where it is what is wanted already; else
// written. The frame keeps the memory for its colours, unless the picture has no luma: then they are made at
// once. Its size is set by whoever calls.
template <typename Memory>
void put_picture(camera::Frame& frame, std::shared_ptr<Memory> memory, const LumaPlane& plane) {
  frame.bgr.clear();
  const bool is_there = plane.data == nullptr || plane.in_place().data != nullptr;
  is_there ? frame.luma.clear() : plane.write(frame.luma);
  if (plane.data == nullptr)
    memory->bgr_into(frame.bgr);
  else
    frame.memory = std::move(memory);
}

}  // namespace arthronaut::sources
