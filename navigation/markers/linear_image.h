// A raw picture read in linear light. Blur happens in light, before the camera's gamma: on encoded grey
// levels the bright side of an edge wins, and a dark square measures too small (0.1 mm of depth at 25 mm).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "navigation/camera/frame.h"

namespace arthronaut::markers {

class LinearTable {
 public:
  // Grey level 255 is light 255, for readability.
  explicit LinearTable(double gamma) {
    for (int level = 0; level < 256; ++level)
      light_[level] = static_cast<float>(255 * std::pow(level / 255.0, gamma));
  }
  [[nodiscard]] float operator[](int level) const { return light_[level]; }

 private:
  std::array<float, 256> light_{};
};

class LinearImage {
 public:
  static constexpr int kSaturated = 252;

  LinearImage(const camera::GrayView& view, const LinearTable& table) : view_(view), table_(table) {}

  [[nodiscard]] bool contains(double x, double y) const {
    return x >= 0 && y >= 0 && x < view_.width - 1 && y < view_.height - 1;
  }
  // Bilinear, in light. Precondition: contains(x, y). A negative value: one of the four pixels is saturated.
  [[nodiscard]] float sample(float x, float y) const {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
    const std::uint8_t* top = view_.row(row) + column;
    const std::uint8_t* bottom = top + view_.stride;
    if (top[0] >= kSaturated || top[1] >= kSaturated || bottom[0] >= kSaturated || bottom[1] >= kSaturated)
      return -1;
    const float upper = table_[top[0]] + right * (table_[top[1]] - table_[top[0]]);
    const float lower = table_[bottom[0]] + right * (table_[bottom[1]] - table_[bottom[0]]);
    return upper + below * (lower - upper);
  }
  // The same from the even rows alone, or from the odd ones. Precondition: contains(x, y - 2) and (x, y + 2).
  [[nodiscard]] float sample_field(float x, float y, int parity) const {
    const int row = (static_cast<int>(y) - parity) / 2 * 2 + parity;
    const float below = 0.5F * (y - static_cast<float>(row));
    const float upper = sample_row(x, row), lower = sample_row(x, row + 2);
    return upper < 0 || lower < 0 ? -1 : upper + below * (lower - upper);
  }
  [[nodiscard]] const camera::GrayView& view() const { return view_; }

 private:
  [[nodiscard]] float sample_row(float x, int row) const {
    const int column = static_cast<int>(x);
    const std::uint8_t* left = view_.row(row) + column;
    if (left[0] >= kSaturated || left[1] >= kSaturated) return -1;
    return table_[left[0]] + (x - static_cast<float>(column)) * (table_[left[1]] - table_[left[0]]);
  }

  camera::GrayView view_;
  const LinearTable& table_;
};

}  // namespace arthronaut::markers
