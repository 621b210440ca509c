// Two screens beside each other as one window: the seam between them is its middle.
#pragma once

#include <optional>
#include <vector>

namespace arthronaut::widgets {

// In the coordinates of the desktop, as GLFW counts them: y down.
struct ScreenArea {
  int x = 0, y = 0, width = 0, height = 0;
};

// A window across two screens that stand side by side, the first that is named among them if it can be: of
// both the part beside the seam, as wide as the narrower one and as high as what both show. Nothing where no
// two touch so, or where too little is left for a window.
[[nodiscard]] std::optional<ScreenArea> across_two(const std::vector<ScreenArea>& screens);

// Whether an area is so wide that it is two screens and not one: two of 4:3 are, one of 21:9 is not.
[[nodiscard]] constexpr bool is_two_screens(float width, float height) { return width > 2.45F * height; }

}  // namespace arthronaut::widgets
