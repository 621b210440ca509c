#include "app/widgets/key_queue.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace arthronaut::widgets {

namespace {

using Kind = KeyEvent::Kind;

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

// A press that does something to a text: Backspace, arrows, Enter, Ctrl+A.
bool edits(const KeyEvent& event) {
  if (event.kind == Kind::Text || event.kind == Kind::Release || is_modifier(event.key)) return false;
  return event.key >= GLFW_KEY_ESCAPE || (event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
}

// Whether an event would undo or overtake another one of the same frame.
bool clashes(const KeyEvent& event, const KeyEvent& before) {
  // A key that is held must not go on after it is let go: its repeats don't queue up.
  if (event.kind == Kind::Repeat && event.key == before.key) return false;
  if (event.kind == Kind::Text) return edits(before);
  if (edits(event) && (before.kind == Kind::Text || edits(before))) return true;
  // A modifier that is let go must not be gone when the key it was pressed for is looked at.
  if (event.kind == Kind::Release && is_modifier(event.key)) return before.kind == Kind::Press;
  return event.key == before.key;
}

}  // namespace

// GLFW gives a letter right after the press, or the repeat, that types it.
bool KeyQueue::is_of_a_command(const KeyEvent& text) const {
  return text.kind == Kind::Text && newest_.kind == Kind::Repeat && commands_.contains(newest_.key);
}

void KeyQueue::follow(const KeyEvent& event, bool takes_text) {
  if (event.kind == Kind::Press && !takes_text) commands_.insert(event.key);
  if (event.kind == Kind::Release || (event.kind == Kind::Press && takes_text)) commands_.erase(event.key);
  if (event.kind == Kind::Press || event.kind == Kind::Repeat) newest_ = event;
}

void KeyQueue::take_frame(std::vector<KeyEvent>& events, bool takes_text) {
  events.clear();
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const KeyEvent& next = waiting_.front();
    if (is_of_a_command(next)) continue;
    if (std::any_of(events.begin(), events.end(),
                    [&](const KeyEvent& before) { return clashes(next, before); }))
      return;
    follow(next, takes_text);
    events.push_back(next);
  }
}

}  // namespace arthronaut::widgets
