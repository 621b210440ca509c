#include "app/widgets/key_labels.h"

#include <GLFW/glfw3.h>

namespace arthronaut::widgets {

LabelledKey labelled_key(int key, int mods, std::string_view printed) {
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return {GLFW_KEY_0 + key - GLFW_KEY_KP_0, mods};
  switch (key) {
    case GLFW_KEY_KP_ADD:
      return {GLFW_KEY_EQUAL, mods & ~GLFW_MOD_SHIFT};
    case GLFW_KEY_KP_SUBTRACT:
      return {GLFW_KEY_MINUS, mods};
    case GLFW_KEY_KP_DECIMAL:
      return {GLFW_KEY_PERIOD, mods};
    case GLFW_KEY_KP_ENTER:
      return {GLFW_KEY_ENTER, mods};
    default:
      break;
  }
  const bool prints = key >= GLFW_KEY_SPACE + 1 && key < GLFW_KEY_ESCAPE;
  if (prints && printed.size() == 1) {
    const char letter = printed.front();
    if (letter >= 'a' && letter <= 'z') key = GLFW_KEY_A + (letter - 'a');
    if (letter >= 'A' && letter <= 'Z') key = GLFW_KEY_A + (letter - 'A');
    if (letter == '+') key = GLFW_KEY_EQUAL;
    if (letter == '-') key = GLFW_KEY_MINUS;
  }
  if (key == GLFW_KEY_EQUAL) mods &= ~GLFW_MOD_SHIFT;  // where "+" stands above "="
  return {key, mods};
}

}  // namespace arthronaut::widgets
