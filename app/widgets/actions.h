// Everything the user can do, once: name, words, key, when it is possible, and the doing. Buttons, keys, the
// key list and tests all go through it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/widgets/graphics_window.h"
#include "app/widgets/hold_guard.h"

namespace arthronaut::widgets {

// Of an action that ends or discards something for good: its key or button must be held down, see HoldGuard.
struct Hold {
  std::string to;                   // "stop", as in "Hold Esc to stop"; empty: a press is enough
  std::function<bool()> when = {};  // else a press is enough; empty: always
};

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
  Hold hold = {};
  std::function<std::string()> why_not = {};  // while it is not enabled: "pictures come: end them first"
  [[nodiscard]] bool can_run() const { return !is_enabled || is_enabled(); }
  [[nodiscard]] bool needs_hold() const { return !hold.to.empty() && (!hold.when || hold.when()); }
};

// "Ctrl+Z", "Space", "F1".
[[nodiscard]] std::string key_name(int key, int mods);

class Actions {
 public:
  void add(Action action);  // ids are unique: a second one replaces the first
  [[nodiscard]] const Action* find(std::string_view id) const;
  [[nodiscard]] const std::vector<Action>& all() const { return actions_; }
  // Runs the action at once when it exists and is enabled; returns whether it ran. Not for what a hand does.
  bool run(std::string_view id) const;

  // A frame: first every release and press, then the buttons, then advance().
  // The first enabled action whose id starts with one of the prefixes and whose key this is runs, or begins
  // to be held; returns whether there is one. Any other key lets go of what is held.
  bool press(const KeyPress& press, const std::vector<std::string_view>& prefixes);
  void release(int key);
  // The button of an action was pressed, let go, or the pointer has left it. Unknown ids are nothing.
  void press_button(std::string_view id);
  void release_button(std::string_view id);
  // Runs what has been held long enough. What is not possible any more is let go.
  void advance(double now_s);
  void let_go() { guard_.cancel(); }
  // Says how the action is to be done, as if it had been let go too early.
  void remind(std::string_view id) { guard_.remind(std::string(id)); }

  [[nodiscard]] bool is_held() const { return guard_.is_held(); }
  [[nodiscard]] double held_share() const { return guard_.progress(); }  // 0 to 1
  [[nodiscard]] double hold_progress(std::string_view id) const;         // 0 to 1
  // "Hold Esc to stop", while it is held and for a while after it was let go too early; empty else.
  [[nodiscard]] std::string hold_words() const;

 private:
  bool begin(const Action& action);

  std::vector<Action> actions_;
  HoldGuard guard_;
};

}  // namespace arthronaut::widgets
