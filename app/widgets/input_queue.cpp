#include "app/widgets/input_queue.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace arthronaut::widgets {

namespace {

using Kind = InputEvent::Kind;

bool is_shift(int key) { return key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT; }
bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

// A press that does something to a text: Backspace, arrows, Enter, Ctrl+A.
bool edits(const InputEvent& event) {
  if (event.kind == Kind::Text || event.kind == Kind::Release || is_modifier(event.key)) return false;
  return event.key >= GLFW_KEY_ESCAPE || (event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
}

// A key that types, where a field has the keys: what it types is told by Text.
bool only_types(const InputEvent& event) {
  return is_shift(event.key) || (event.key < GLFW_KEY_ESCAPE && !edits(event));
}

// Of two of which one at least is the mouse's. What a key opened, or a click, is there in the next frame.
bool clashes_with_mouse(const InputEvent& event, const InputEvent& before) {
  // A key that is held while the wheel turns would wait a frame for each turn, and its release with it.
  const auto are = [&](Kind one, Kind other) {
    return (event.kind == one && before.kind == other) || (event.kind == other && before.kind == one);
  };
  if (are(Kind::Repeat, Kind::Wheel)) return false;
  if (is_of_mouse(event) && is_of_mouse(before))
    return event.kind != Kind::Wheel || before.kind != Kind::Wheel;
  if (is_of_mouse(event)) return before.kind != Kind::Release && !is_modifier(before.key);
  return event.kind != Kind::Release || is_modifier(event.key);
}

// Whether an event would undo or overtake another one of the same frame.
bool clashes(const InputEvent& event, const InputEvent& before, bool takes_text) {
  if (is_of_mouse(event) || is_of_mouse(before)) return clashes_with_mouse(event, before);
  // A key that is held must not go on after it is let go: its repeats don't queue up.
  if (event.kind == Kind::Repeat && event.key == before.key) return false;
  if (event.kind == Kind::Text) return edits(before);
  if (edits(event) && (before.kind == Kind::Text || edits(before))) return true;
  if (takes_text && only_types(event) && only_types(before)) return false;
  // A modifier that is let go must not be gone when the key it was pressed for is looked at.
  if (event.kind == Kind::Release && is_modifier(event.key)) return before.kind == Kind::Press;
  return event.key == before.key;
}

}  // namespace

bool is_of_mouse(const InputEvent& event) {
  return event.kind == Kind::ButtonPress || event.kind == Kind::ButtonRelease || event.kind == Kind::Wheel;
}

bool InputQueue::waits_with_mouse() const {
  return std::any_of(waiting_.begin(), waiting_.end(), is_of_mouse);
}

// GLFW gives a letter right after the press, or the repeat, that types it.
bool InputQueue::is_of_a_command(const InputEvent& text) const {
  return text.kind == Kind::Text && newest_.kind == Kind::Repeat && commands_.contains(newest_.key);
}

void InputQueue::follow(const InputEvent& event, bool takes_text) {
  if (event.kind == Kind::Press && !takes_text) commands_.insert(event.key);
  if (event.kind == Kind::Release || (event.kind == Kind::Press && takes_text)) commands_.erase(event.key);
  if (event.kind == Kind::Press || event.kind == Kind::Repeat) newest_ = event;
}

void InputQueue::take_frame(std::vector<InputEvent>& events, bool takes_text) {
  events.clear();
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const InputEvent& next = waiting_.front();
    if (is_of_a_command(next)) continue;
    if (std::any_of(events.begin(), events.end(),
                    [&](const InputEvent& before) { return clashes(next, before, takes_text); }))
      return;
    follow(next, takes_text);
    events.push_back(next);
  }
}

}  // namespace arthronaut::widgets
