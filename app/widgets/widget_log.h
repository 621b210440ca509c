// What is on the screen and where, for tests that drive the window from outside. Printed when it changes and
// has reached the screen, widgets before states:
//   WIDGET name x y width height       window pixels
//   READY                              the list above is complete
//   STATE key value
//   FRAME name=number ...              closes every frame: what it cost and what it held
#pragma once

#include <imgui.h>

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/widgets/layout.h"

namespace arthronaut::widgets {

class WidgetLog {
 public:
  explicit WidgetLog(bool prints) : prints_(prints) {}
  void note(std::string_view name, const ImVec2& min, const ImVec2& max);
  // The same of what can be clicked on.
  void note_button(std::string_view name, const ImVec2& min, const ImVec2& max);
  // Where these were in the last frame, whether or not any of it is printed.
  [[nodiscard]] const std::vector<Rect>& buttons() const { return buttons_; }
  void note_state(std::string_view key, std::string_view value);
  // Adds to a number of this frame: a count, bytes, milliseconds.
  void add(std::string_view what, double amount);
  // Call once a frame after the swap. FRAME names the moment as "shown_s", on the steady clock.
  void end_frame();

  // Adds the milliseconds from here to the end of its scope. On software OpenGL most of what is drawn is
  // computed later, while other parts are prepared, and at the latest during the swap.
  class Timed {
   public:
    Timed(WidgetLog& log, std::string_view what) : log_(log), what_(what) {}
    ~Timed() { log_.add(what_, std::chrono::duration<double, std::milli>(Clock::now() - begun_).count()); }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

   private:
    using Clock = std::chrono::steady_clock;
    WidgetLog& log_;
    std::string_view what_;
    Clock::time_point begun_ = Clock::now();
  };

 private:
  bool prints_;
  std::string frame_, printed_, new_states_;
  std::vector<Rect> buttons_, next_buttons_;
  std::map<std::string, std::string, std::less<>> states_;
  std::map<std::string, double, std::less<>> numbers_;
};

}  // namespace arthronaut::widgets
