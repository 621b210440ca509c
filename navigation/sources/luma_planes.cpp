#include "navigation/sources/luma_planes.h"

#include <array>
#include <cstring>

namespace arthronaut::sources {

namespace {

// 255/219 of what lies above 16: exact to half a step. All of it fits 16 bits, and nothing of it is a branch.
inline std::uint8_t stretched(std::uint8_t luma) {
  const auto above = static_cast<std::uint16_t>(luma < 16 ? 0 : luma > 235 ? 219 : luma - 16);
  return static_cast<std::uint8_t>(above + ((above * 42U + 128U) >> 8));
}

template <bool kStretch>
inline std::uint8_t at_last(std::uint8_t luma) {
  if constexpr (kStretch) return stretched(luma);
  return luma;
}

// Samples of a byte, many at a time: a compiler does so where it knows how many, and that what is written
// is not what is read. One by one a picture took longer than its decoding.
template <bool kStretch, int kStep>
void write_bytes(const std::uint8_t* from, int width, std::uint8_t* to) {
  constexpr int kMany = 32;
  int x = 0;
  for (; x + kMany < width; x += kMany, from += kMany * kStep, to += kMany) {
    std::array<std::uint8_t, kMany * kStep> read;
    std::array<std::uint8_t, kMany> written;
    std::memcpy(read.data(), from, read.size());
    for (std::size_t i = 0; i < kMany; ++i) written[i] = at_last<kStretch>(read[i * kStep]);
    std::memcpy(to, written.data(), written.size());
  }
  for (; x < width; ++x, from += kStep) *to++ = at_last<kStretch>(*from);
}

template <bool kStretch>
void write_row(const LumaPlane& plane, const std::uint8_t* from, std::uint8_t* to) {
  if (plane.bits > 8) {
    const int down = plane.shift + plane.bits - 8;
    for (int x = 0; x < plane.width; ++x, from += plane.step) {
      const unsigned sample = static_cast<unsigned>(from[0]) | (static_cast<unsigned>(from[1]) << 8);
      to[x] = at_last<kStretch>(static_cast<std::uint8_t>(sample >> down));
    }
  } else if (plane.step == 1) {
    write_bytes<kStretch, 1>(from, plane.width, to);
  } else if (plane.step == 2) {
    write_bytes<kStretch, 2>(from, plane.width, to);
  } else {
    for (int x = 0; x < plane.width; ++x) to[x] = at_last<kStretch>(from[x * plane.step]);
  }
}

}  // namespace

void LumaPlane::write(std::vector<std::uint8_t>& luma) const {
  luma.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* const from = data + y * stride;
    std::uint8_t* const to = luma.data() + static_cast<std::ptrdiff_t>(y) * width;
    is_full_range ? write_row<false>(*this, from, to) : write_row<true>(*this, from, to);
  }
}

}  // namespace arthronaut::sources
