#include "app/widgets/actions.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "app/widgets/controls.h"

namespace arthronaut::widgets {
namespace {

struct Counter {
  int runs = 0;
  bool enabled = true;
  Actions actions;
  explicit Counter(bool repeats = false) {
    actions.add({"plan.undo",
                 "Undo",
                 "",
                 GLFW_KEY_Z,
                 GLFW_MOD_CONTROL,
                 repeats,
                 [this] { return enabled; },
                 {},
                 [this] { ++runs; }});
  }
  bool press(int key, int mods, bool is_repeat = false, std::string_view prefix = "plan.") {
    return actions.press({key, mods, is_repeat}, {prefix});
  }
};

// A key runs its action with exactly its modifiers, in its mode alone, and only while it is possible.
TEST(Actions, KeyRunsWhatItIsForAndNothingElse) {
  Counter counter;
  EXPECT_TRUE(counter.press(GLFW_KEY_Z, GLFW_MOD_CONTROL));
  EXPECT_FALSE(counter.press(GLFW_KEY_Z, 0));
  EXPECT_FALSE(counter.press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT));
  EXPECT_FALSE(counter.press(GLFW_KEY_Z, GLFW_MOD_CONTROL, false, "navigate."));
  counter.enabled = false;
  EXPECT_FALSE(counter.press(GLFW_KEY_Z, GLFW_MOD_CONTROL));
  EXPECT_FALSE(counter.actions.run("plan.undo"));
  EXPECT_EQ(counter.runs, 1);
}

// A held key repeats only what may repeat: nobody starts an operation ten times by a heavy foot.
TEST(Actions, HeldKeysRepeatOnlyWhereAllowed) {
  EXPECT_FALSE(Counter(false).press(GLFW_KEY_Z, GLFW_MOD_CONTROL, true));
  EXPECT_TRUE(Counter(true).press(GLFW_KEY_Z, GLFW_MOD_CONTROL, true));
}

// Keys are named as they are printed on keyboards.
TEST(Actions, KeysHaveNames) {
  EXPECT_EQ(key_name(GLFW_KEY_Z, GLFW_MOD_CONTROL), "Ctrl+Z");
  EXPECT_EQ(key_name(GLFW_KEY_F10, 0), "F10");
  EXPECT_EQ(key_name(GLFW_KEY_SPACE, GLFW_MOD_SHIFT), "Shift+Space");
  EXPECT_EQ(key_name(GLFW_KEY_BACKSPACE, 0), "Backsp");
  EXPECT_EQ(key_name(0, 0), "");
}

// Numbers on the screen: a true minus sign, never a negative nought.
TEST(FixedNumbers, HaveNoNegativeNought) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(fixed(-12.34, 1), "\u221212.3");
  EXPECT_EQ(fixed(-0.04, 1), "0.0");
}

}  // namespace
}  // namespace arthronaut::widgets
