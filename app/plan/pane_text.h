// Where a word stands that belongs to a point of a picture.
#pragma once

#include <algorithm>

#include "app/widgets/controls.h"

namespace arthronaut::plan {

// The upper left corner of a text of that size: to the right of the point, but never over the edge of the
// picture, where half of a number would be cut off and the rest be read as the whole.
[[nodiscard]] inline ImVec2 beside(const ImVec2& point, const ImVec2& text, float gap,
                                   const widgets::Rect& picture) {
  const auto within = [](float wanted, float from, float room) {
    return std::clamp(wanted, from, from + std::max(room, 0.F));
  };
  return {within(point.x + gap, picture.x, picture.width - text.x),
          within(point.y, picture.y, picture.height - text.y)};
}

}  // namespace arthronaut::plan
