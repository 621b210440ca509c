// Keys and typed letters in the order they came, dealt out so that a screen sees every one of them. ImGui
// looks once a frame at which keys are down: a key that is pressed and let go between two frames would not
// exist, and one that follows letters would come before them.
#pragma once

#include <deque>
#include <vector>

namespace arthronaut::widgets {

struct KeyEvent {
  enum class Kind { Press, Repeat, Release, Text } kind = Kind::Press;
  int key = 0;                 // GLFW_KEY_*; of Text: 0
  int scancode = 0, mods = 0;  // as GLFW gives them
  unsigned codepoint = 0;      // of Text
};

class KeyQueue {
 public:
  void add(const KeyEvent& event) { waiting_.push_back(event); }
  // What belongs to the next frame, into `events`: as much as keeps its order and leaves every key that goes
  // down down for a frame.
  void take_frame(std::vector<KeyEvent>& events);
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

 private:
  std::deque<KeyEvent> waiting_;
};

}  // namespace arthronaut::widgets
