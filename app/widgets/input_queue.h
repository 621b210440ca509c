// Keys, typed letters, clicks and the turns of the wheel in the order they came, dealt out so that a screen
// sees every one of them. ImGui looks once a frame at which keys and buttons are down: a key that is pressed
// and let go between two frames would not exist, one that follows letters would come before them, and a
// click would overtake the letters that were typed before it.
#pragma once

#include <deque>
#include <set>
#include <vector>

namespace arthronaut::widgets {

struct CursorPlace {
  double x_px = 0, y_px = 0;  // in the window, as GLFW gives it
};

struct InputEvent {
  enum class Kind { Press, Repeat, Release, Text, ButtonPress, ButtonRelease, Wheel } kind = Kind::Press;
  int key = 0;                 // GLFW_KEY_*; of a button: GLFW_MOUSE_BUTTON_*; of others: 0
  int scancode = 0, mods = 0;  // as GLFW gives them
  unsigned codepoint = 0;      // of Text
  CursorPlace place = {};      // of a button and the wheel: where the cursor was then
  double wheel_x = 0, wheel_y = 0;
};

[[nodiscard]] bool is_of_mouse(const InputEvent& event);

class InputQueue {
 public:
  void add(const InputEvent& event) { waiting_.push_back(event); }
  // What belongs to the next frame, into `events`: as much as keeps its order and leaves every key that goes
  // down, and every button, down for a frame. takes_text: a field has the keys. To it letters are letters,
  // and the keys that type them none that must be seen down: a burst of them is one frame's. What a key that
  // went down where no field had it types by being held on is left out: it is the hand that opened the
  // field, and writes nothing into it.
  void take_frame(std::vector<InputEvent>& events, bool takes_text);
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }
  // Whether a click or the wheel waits: until its frame has come the cursor stands where it stood.
  [[nodiscard]] bool waits_with_mouse() const;

 private:
  [[nodiscard]] bool is_of_a_command(const InputEvent& text) const;
  void follow(const InputEvent& event, bool takes_text);

  std::deque<InputEvent> waiting_;
  std::set<int> commands_;  // keys that are down and went down where no field had them
  InputEvent newest_;       // that was pressed or repeats
};

}  // namespace arthronaut::widgets
