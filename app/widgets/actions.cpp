#include "app/widgets/actions.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace arthronaut::widgets {

namespace {

std::string plain_key_name(int key) {
  if (key >= GLFW_KEY_A && key <= GLFW_KEY_Z)
    return std::string(1, static_cast<char>('A' + key - GLFW_KEY_A));
  if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)
    return std::string(1, static_cast<char>('0' + key - GLFW_KEY_0));
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
  switch (key) {
    case GLFW_KEY_SPACE:
      return "Space";
    case GLFW_KEY_TAB:
      return "Tab";
    case GLFW_KEY_ENTER:
      return "Enter";
    case GLFW_KEY_BACKSPACE:
      return "Backsp";
    case GLFW_KEY_ESCAPE:
      return "Esc";
    case GLFW_KEY_LEFT:
      return "\u2190";
    case GLFW_KEY_RIGHT:
      return "\u2192";
    case GLFW_KEY_UP:
      return "\u2191";
    case GLFW_KEY_DOWN:
      return "\u2193";
    case GLFW_KEY_HOME:
      return "Home";
    case GLFW_KEY_END:
      return "End";
    case GLFW_KEY_PAGE_UP:
      return "Page up";
    case GLFW_KEY_PAGE_DOWN:
      return "Page down";
    case GLFW_KEY_DELETE:
      return "Del";
    case GLFW_KEY_COMMA:
      return ",";
    case GLFW_KEY_PERIOD:
      return ".";
    case GLFW_KEY_MINUS:
      return "-";
    case GLFW_KEY_EQUAL:
      return "+";
    default:
      return "";
  }
}

}  // namespace

std::string key_name(int key, int mods) {
  const std::string plain = plain_key_name(key);
  if (plain.empty()) return "";
  return std::string((mods & GLFW_MOD_CONTROL) != 0 ? "Ctrl+" : "") +
         ((mods & GLFW_MOD_ALT) != 0 ? "Alt+" : "") + ((mods & GLFW_MOD_SHIFT) != 0 ? "Shift+" : "") + plain;
}

void Actions::add(Action action) {
  const auto same =
      std::find_if(actions_.begin(), actions_.end(), [&](const Action& a) { return a.id == action.id; });
  if (same != actions_.end())
    *same = std::move(action);
  else
    actions_.push_back(std::move(action));
}

const Action* Actions::find(std::string_view id) const {
  const auto found =
      std::find_if(actions_.begin(), actions_.end(), [&](const Action& a) { return a.id == id; });
  return found == actions_.end() ? nullptr : &*found;
}

bool Actions::run(std::string_view id) const {
  const Action* action = find(id);
  if (action == nullptr || !action->can_run()) return false;
  action->run();
  return true;
}

bool Actions::begin(const Action& action) {
  if (action.needs_hold())
    guard_.press(action.id);
  else
    action.run();
  return true;
}

bool Actions::press(const KeyPress& press, const std::vector<std::string_view>& prefixes) {
  if (!press.is_repeat) guard_.cancel();  // two keys at once are a hand that lies on the keyboard
  for (const Action& action : actions_) {
    if (action.key != press.key || action.mods != press.mods || action.key == 0) continue;
    if (press.is_repeat && (!action.repeats || action.needs_hold())) continue;
    const bool in_reach = std::any_of(prefixes.begin(), prefixes.end(),
                                      [&](std::string_view prefix) { return action.id.starts_with(prefix); });
    if (in_reach && action.can_run()) return begin(action);
  }
  return false;
}

void Actions::release(int key) {
  const Action* held = guard_.is_held() ? find(guard_.what()) : nullptr;
  if (held == nullptr) return;
  const bool is_modifier = key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
  if (key == held->key || (is_modifier && held->mods != 0)) guard_.let_go();
}

void Actions::press_button(std::string_view id) {
  const Action* action = find(id);
  if (action != nullptr && action->can_run()) begin(*action);
}

void Actions::release_button(std::string_view id) {
  if (guard_.what() == id) guard_.let_go();
}

void Actions::advance(double now_s) {
  const std::string what = guard_.what();
  const Action* action = guard_.is_held() ? find(what) : nullptr;
  if (guard_.is_held() && (action == nullptr || !action->can_run() || !action->needs_hold())) guard_.cancel();
  if (guard_.advance(now_s) && action != nullptr) action->run();
}

double Actions::hold_progress(std::string_view id) const {
  return guard_.what() == id ? guard_.progress() : 0;
}

std::string Actions::hold_words() const {
  const Action* action = find(guard_.what());
  if (action == nullptr || action->hold.to.empty()) return "";
  const std::string key = key_name(action->key, action->mods);
  return "Hold " + (key.empty() ? "the button" : key) + " to " + action->hold.to;
}

}  // namespace arthronaut::widgets
