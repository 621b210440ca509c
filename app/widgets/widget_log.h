// What is on the screen and where, for tests that drive the window from outside. Printed when it changes and
// has reached the screen, widgets before states:
//   WIDGET name x y width height       window pixels
//   READY                              the list above is complete
//   STATE key value
#pragma once

#include <imgui.h>

#include <map>
#include <string>
#include <string_view>

namespace arthronaut::widgets {

class WidgetLog {
 public:
  explicit WidgetLog(bool prints) : prints_(prints) {}
  void note(std::string_view name, const ImVec2& min, const ImVec2& max);
  void note_state(std::string_view key, std::string_view value);
  // Call once a frame after the swap.
  void end_frame();

 private:
  bool prints_;
  std::string frame_, printed_, new_states_;
  std::map<std::string, std::string, std::less<>> states_;
};

}  // namespace arthronaut::widgets
