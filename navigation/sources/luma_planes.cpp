#include "navigation/sources/luma_planes.h"

#include <algorithm>

namespace arthronaut::sources {

namespace {

// 255/219 of what lies above 16, in 16 bits so that a compiler does many at a time: exact to half a step.
inline std::uint8_t stretched(std::uint8_t luma) {
  const auto above = static_cast<std::uint16_t>(std::clamp<std::uint8_t>(luma, 16, 235) - 16);
  return static_cast<std::uint8_t>(above + ((above * 42U + 128U) >> 8));
}

template <bool kStretch>
inline std::uint8_t at_last(std::uint8_t luma) {
  if constexpr (kStretch) return stretched(luma);
  return luma;
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
    for (int x = 0; x < plane.width; ++x) to[x] = at_last<kStretch>(from[x]);
  } else if (plane.step == 2) {
    for (int x = 0; x < plane.width; ++x) to[x] = at_last<kStretch>(from[2 * x]);
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
