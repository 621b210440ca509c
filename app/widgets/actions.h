// Everything the user can do, once: name, words, key, when it is possible, and the doing. Buttons, keys, the
// key list and tests all go through it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/widgets/graphics_window.h"

namespace arthronaut::widgets {

struct Action {
  std::string id;       // "plan.undo": stable, for tests
  std::string label;    // "Undo"
  std::string tooltip;  // a sentence
  int key = 0;          // GLFW_KEY_*; 0: none
  int mods = 0;
  bool repeats = false;              // while the key is held
  std::function<bool()> is_enabled;  // empty: always
  std::function<bool()> is_on;       // for switches; empty: not a switch
  std::function<void()> run;
};

// "Ctrl+Z", "Space", "F1".
[[nodiscard]] std::string key_name(int key, int mods);

class Actions {
 public:
  void add(Action action);  // ids are unique: a second one replaces the first
  [[nodiscard]] const Action* find(std::string_view id) const;
  [[nodiscard]] const std::vector<Action>& all() const { return actions_; }
  // Runs the action when it exists and is enabled; returns whether it ran.
  bool run(std::string_view id) const;
  // The first enabled action whose id starts with one of the prefixes and whose key this is.
  bool press(const KeyPress& press, const std::vector<std::string_view>& prefixes) const;

 private:
  std::vector<Action> actions_;
};

}  // namespace arthronaut::widgets
