// What the window showed, copied for somebody who is not there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace arthronaut::widgets {

struct ScreenPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgra;  // 4 * width * height, bottom row first, as OpenGL gives it
  double time_s = 0;               // on the clock of GraphicsWindow::now_s()
};
using ScreenPicturePtr = std::shared_ptr<const ScreenPicture>;

// Before GraphicsWindow::draw_frame(): fills the picture with what it shows, which must live until then. In
// the picture's own memory, which is reused where it is large enough.
void copy_screen_into(ScreenPicture& picture, double now_s);

}  // namespace arthronaut::widgets
