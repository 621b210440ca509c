// Keys by what is printed on them. GLFW names a key by its place on a keyboard of the United States: what a
// German one has "Z" on is its Y, and "+" stands elsewhere on every second layout. Actions are meant for the
// print.
#pragma once

#include <string_view>

namespace arthronaut::widgets {

struct LabelledKey {
  int key = 0;   // GLFW_KEY_*
  int mods = 0;  // GLFW_MOD_*
  bool operator==(const LabelledKey&) const = default;
};

// The key that an action is found by. `printed` is what the layout has on the key (glfwGetKeyName), empty
// when that is not known. Letters and "+", "-" follow the print; "+" is GLFW_KEY_EQUAL without Shift, however
// it was typed. The number pad's keys are those of the same name: digits, "+", "-", ".", Enter. Every other
// key stays what it is.
[[nodiscard]] LabelledKey labelled_key(int key, int mods, std::string_view printed);

}  // namespace arthronaut::widgets
