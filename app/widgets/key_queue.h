// Keys and typed letters in the order they came, dealt out so that a screen sees every one of them. ImGui
// looks once a frame at which keys are down: a key that is pressed and let go between two frames would not
// exist, and one that follows letters would come before them.
#pragma once

#include <deque>
#include <set>
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
  // down down for a frame. takes_text: a field has the keys. What a key that went down where none had them
  // types by being held on is left out: it is the hand that opened the field, and writes nothing into it.
  void take_frame(std::vector<KeyEvent>& events, bool takes_text);
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

 private:
  [[nodiscard]] bool is_of_a_command(const KeyEvent& text) const;
  void follow(const KeyEvent& event, bool takes_text);

  std::deque<KeyEvent> waiting_;
  std::set<int> commands_;  // keys that are down and went down where no field had them
  KeyEvent newest_;         // that was pressed or repeats
};

}  // namespace arthronaut::widgets
