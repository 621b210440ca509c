// The one window, its OpenGL context and ImGui. One thread owns all of it: the one that made it.
//
// Frame order: poll -> drain queues and actions (logic) -> build UI -> render the scenes that are dirty ->
// draw UI -> swap. begin_frame() is the first step, draw_frame() and show_frame() the last two.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/widgets/theme.h"

namespace arthronaut::widgets {

struct KeyPress {
  int key = 0;   // GLFW_KEY_*
  int mods = 0;  // GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT
  bool is_repeat = false;
};

class GraphicsWindow {
 public:
  // As large as the screen. diagonal_mm: of the screen, as the user says; 0: as the screen says. Throws
  // DeviceError when there is no display or no OpenGL 3.3.
  explicit GraphicsWindow(const std::string& title, double diagonal_mm = 0);
  ~GraphicsWindow();
  GraphicsWindow(const GraphicsWindow&) = delete;
  GraphicsWindow& operator=(const GraphicsWindow&) = delete;

  // Waits for input at most `timeout_s` (0: does not wait), or until wake(), then starts a frame. Where the
  // processor draws, a frame without input waits for its turn beyond that (DrawPace); one with input never
  // does. Keys and clicks are dealt out as InputQueue does; while some wait there is no wait for input.
  // Returns whether input or wake() cut the wait for it short.
  bool begin_frame(double timeout_s);
  void draw_frame();
  // pictures_are_late: the next frames leave them more time (DrawPace).
  void show_frame(bool pictures_are_late = false);
  [[nodiscard]] long drawn_px() const;  // in the last frame: where the processor draws, what changed
  // A text field is about to take the keyboard: what is typed waits for it, a few frames at most.
  void await_text_field();
  // Keys pressed in this frame; where a text field has them, only what means nothing to it (page up).
  [[nodiscard]] const std::vector<KeyPress>& keys() const;
  // Keys let go in this frame (GLFW_KEY_*), also those that a text field has.
  [[nodiscard]] const std::vector<int>& released_keys() const;
  // Files and folders that were dropped on the window since the last call.
  [[nodiscard]] std::vector<std::filesystem::path> take_dropped();
  [[nodiscard]] bool should_close() const;
  void keep_open();  // takes back that it should close
  void make_current() const;
  [[nodiscard]] Screen screen() const;
  // Across two screens that stand side by side, or back where it was. Without two such screens
  // can_cover_two() says no, and cover_two(true) does nothing. A window manager may refuse.
  [[nodiscard]] static bool can_cover_two();
  void cover_two(bool covers);
  [[nodiscard]] bool covers_two() const;
  [[nodiscard]] const Theme& theme() const;
  [[nodiscard]] static double now_s();
  // OpenGL by the processor: what is drawn costs what looks at the pictures (DrawPace).
  [[nodiscard]] bool draws_by_processor() const;
  // From any thread: ends the wait for input in begin_frame().
  static void wake();
  // The same for a hand or a foot that this window does not see itself: counts as input.
  static void wake_by_hand();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::widgets
