#include "app/widgets/key_labels.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

// "+" is one key to an action: typed with Shift above "=", with a key of its own, on the number pad.
TEST(KeyLabels, PlusIsPlusHoweverItIsTyped) {
  const LabelledKey plus{GLFW_KEY_EQUAL, 0};
  EXPECT_EQ(labelled_key(GLFW_KEY_EQUAL, 0, "="), plus);
  EXPECT_EQ(labelled_key(GLFW_KEY_EQUAL, GLFW_MOD_SHIFT, "="), plus);
  EXPECT_EQ(labelled_key(GLFW_KEY_RIGHT_BRACKET, 0, "+"), plus);  // a German keyboard
  EXPECT_EQ(labelled_key(GLFW_KEY_KP_ADD, 0, "+"), plus);
  EXPECT_EQ(labelled_key(GLFW_KEY_KP_ADD, GLFW_MOD_SHIFT, ""), plus);
}

// The number pad does what the keys of the same name do.
TEST(KeyLabels, TheNumberPadDoesWhatItSays) {
  EXPECT_EQ(labelled_key(GLFW_KEY_KP_SUBTRACT, 0, "-"), (LabelledKey{GLFW_KEY_MINUS, 0}));
  EXPECT_EQ(labelled_key(GLFW_KEY_KP_6, 0, "6"), (LabelledKey{GLFW_KEY_6, 0}));
  EXPECT_EQ(labelled_key(GLFW_KEY_KP_ENTER, GLFW_MOD_CONTROL, ""),
            (LabelledKey{GLFW_KEY_ENTER, GLFW_MOD_CONTROL}));
}

// Letters are those that are printed; keys without a letter, and digits, are where they are.
TEST(KeyLabels, LettersFollowThePrint) {
  EXPECT_EQ(labelled_key(GLFW_KEY_Y, GLFW_MOD_CONTROL, "z"), (LabelledKey{GLFW_KEY_Z, GLFW_MOD_CONTROL}));
  EXPECT_EQ(labelled_key(GLFW_KEY_SLASH, 0, "-"), (LabelledKey{GLFW_KEY_MINUS, 0}));
  EXPECT_EQ(labelled_key(GLFW_KEY_1, 0, "&"), (LabelledKey{GLFW_KEY_1, 0}));
  EXPECT_EQ(labelled_key(GLFW_KEY_LEFT, GLFW_MOD_SHIFT, ""), (LabelledKey{GLFW_KEY_LEFT, GLFW_MOD_SHIFT}));
  EXPECT_EQ(labelled_key(GLFW_KEY_Z, 0, ""), (LabelledKey{GLFW_KEY_Z, 0}));
}

}  // namespace
}  // namespace arthronaut::widgets
