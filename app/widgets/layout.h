// Rectangles that a screen is cut into.
#pragma once

#include <imgui.h>

#include <algorithm>

namespace arthronaut::widgets {

struct Rect {
  float x = 0, y = 0, width = 0, height = 0;

  [[nodiscard]] ImVec2 min() const { return {x, y}; }
  [[nodiscard]] ImVec2 max() const { return {x + width, y + height}; }
  [[nodiscard]] ImVec2 center() const { return {x + width / 2, y + height / 2}; }
  [[nodiscard]] bool contains(const ImVec2& p) const {
    return p.x >= x && p.y >= y && p.x < x + width && p.y < y + height;
  }
  [[nodiscard]] Rect inset(float by) const {
    return {x + by, y + by, std::max(width - 2 * by, 0.F), std::max(height - 2 * by, 0.F)};
  }
  // Cuts a strip off this rectangle, with a gap between the two.
  Rect cut_left(float size, float gap = 0) {
    const float taken = std::min(size, width);
    const Rect strip{x, y, taken, height};
    x += taken + gap;
    width = std::max(width - taken - gap, 0.F);
    return strip;
  }
  Rect cut_right(float size, float gap = 0) {
    const float taken = std::min(size, width);
    const Rect strip{x + width - taken, y, taken, height};
    width = std::max(width - taken - gap, 0.F);
    return strip;
  }
  Rect cut_top(float size, float gap = 0) {
    const float taken = std::min(size, height);
    const Rect strip{x, y, width, taken};
    y += taken + gap;
    height = std::max(height - taken - gap, 0.F);
    return strip;
  }
  Rect cut_bottom(float size, float gap = 0) {
    const float taken = std::min(size, height);
    const Rect strip{x, y + height - taken, width, taken};
    height = std::max(height - taken - gap, 0.F);
    return strip;
  }
};

// The largest rectangle of this aspect (width / height) in the middle of another.
[[nodiscard]] inline Rect fitted(const Rect& into, float aspect) {
  const float width = std::min(into.width, into.height * aspect);
  const float height = width / aspect;
  return {into.x + (into.width - width) / 2, into.y + (into.height - height) / 2, width, height};
}

}  // namespace arthronaut::widgets
