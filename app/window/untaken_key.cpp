#include "app/window/untaken_key.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace arthronaut::window {

namespace {

constexpr double kUntakenSaid_s = 5, kPastSaid_s = 1.5;
constexpr const char* kPedal = "navigate.next";  // does the step that is next

}  // namespace

void UntakenKey::note(const widgets::KeyPress& press, const widgets::Actions& actions,
                      const std::vector<std::string_view>& prefixes, bool is_opening, double now_s) {
  const std::string name = widgets::key_name(press.key, press.mods);
  if (press.is_repeat || name.empty()) return;
  noted_at_s_ = now_s;
  holds_ = true;
  action_.clear();
  early_key_.clear();
  if (is_opening) {
    early_key_ = name;
    words_ = name + " did nothing: the case is still being opened. Press it again then";
    return;
  }
  if (press.key == GLFW_KEY_ESCAPE) return;
  const auto is_its = [&](const widgets::Action& action) {
    return action.key == press.key && action.mods == press.mods &&
           std::ranges::any_of(prefixes,
                               [&](std::string_view prefix) { return action.id.starts_with(prefix); });
  };
  const auto its = std::ranges::find_if(actions.all(), is_its);
  if (its == actions.all().end()) {
    // A foot on the pedal does not see that its mode is not in front, as after a crash.
    const bool is_pedal = std::ranges::any_of(actions.all(), [&](const widgets::Action& action) {
      return action.key == press.key && action.mods == press.mods && action.id == kPedal;
    });
    if (is_pedal) words_ = name + " did nothing: the pedal leads in Navigate (F2)";
    return;
  }
  // Of a key that does one thing here and another there nobody knows which was meant.
  const bool is_one = std::ranges::none_of(actions.all(), [&](const widgets::Action& other) {
    return is_its(other) && other.label != its->label;
  });
  const std::string why = is_one && its->why_not ? its->why_not() : "";
  words_ = name +
           " did nothing: " + (is_one ? its->label + " is not possible now" : "there is nothing for it now") +
           (why.empty() ? "" : ": " + why);
  action_ = its->id;
}

void UntakenKey::note_drop(double now_s) {
  words_ = "Nothing that is dropped is taken while something runs: stop it first, then drop it again";
  action_.clear();
  early_key_.clear();
  holds_ = true;
  noted_at_s_ = now_s;
}

void UntakenKey::look_again(const widgets::Actions& actions, bool is_opening, double now_s) {
  if (words_.empty()) return;
  if (!early_key_.empty()) {
    noted_at_s_ = now_s;
    if (is_opening) return;
    words_ = early_key_ + " did nothing: the case was not open yet. Press it again";
    early_key_.clear();
    return;
  }
  const widgets::Action* action = action_.empty() ? nullptr : actions.find(action_);
  holds_ = holds_ && (action_.empty() || action == nullptr || !action->can_run());
}

std::string UntakenKey::words(double now_s) const {
  return now_s - noted_at_s_ < (holds_ ? kUntakenSaid_s : kPastSaid_s) ? words_ : std::string();
}

}  // namespace arthronaut::window
