#include "app/widgets/two_screens.h"

#include <algorithm>

namespace arthronaut::widgets {

namespace {

constexpr int kLeastHeight = 540;

std::optional<ScreenArea> across(const ScreenArea& left, const ScreenArea& right) {
  if (left.x + left.width != right.x) return std::nullopt;
  const int top = std::max(left.y, right.y);
  const int height = std::min(left.y + left.height, right.y + right.height) - top;
  const int half = std::min(left.width, right.width);
  if (height < kLeastHeight || !is_two_screens(2.F * static_cast<float>(half), static_cast<float>(height)))
    return std::nullopt;
  return ScreenArea{right.x - half, top, 2 * half, height};
}

}  // namespace

std::optional<ScreenArea> across_two(const std::vector<ScreenArea>& screens) {
  for (const ScreenArea& one : screens)
    for (const ScreenArea& other : screens) {
      if (const auto right = across(one, other)) return right;
      if (const auto left = across(other, one)) return left;
    }
  return std::nullopt;
}

}  // namespace arthronaut::widgets
