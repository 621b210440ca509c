// Draws ImGui's frame into the window and shows it. Where the processor draws and the system can show a part
// of a window (GLX_MESA_copy_sub_buffer, which also says that what was drawn stays), only what changed is
// drawn and shown; else all of it. On the thread that owns the context.
#pragma once

#include <cstdint>

#include "app/widgets/draw_damage.h"

struct GLFWwindow;

namespace arthronaut::widgets {

class ScreenDrawing {
 public:
  ScreenDrawing() = default;  // draws everything
  // The window's context is current.
  ScreenDrawing(GLFWwindow* window, bool by_processor);

  void draw();
  void show();
  // What stands on the screen was lost: the window was covered, or is of another size.
  void forget() { frames_to_draw_whole_ = kFramesToDrawWhole; }
  // Of the last frame, pixels.
  [[nodiscard]] long drawn_px() const { return drawn_px_; }

 private:
  // A window system takes a frame or two to have a buffer of the window's new size. All but the last are
  // swapped, whose buffer is anybody's afterwards.
  static constexpr int kFramesToDrawWhole = 3;
  using CopyPart = void (*)(void* display, unsigned long drawable, int x, int y, int width, int height);

  GLFWwindow* window_ = nullptr;
  CopyPart copy_part_ = nullptr;  // null: all of it is drawn and swapped
  void* display_ = nullptr;
  unsigned long drawable_ = 0;
  int frames_to_draw_whole_ = kFramesToDrawWhole;
  DrawDamage damage_;
  PixelArea known_, shown_;  // the window's; what of it the last frame drew
  long drawn_px_ = 0;
};

}  // namespace arthronaut::widgets
