#include "app/widgets/hold_guard.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "app/widgets/actions.h"

namespace arthronaut::widgets {
namespace {

// A workstation's keys, as hands and frames come: 50 frames a second unless told otherwise.
struct Keys {
  int stops = 0, clears = 0, steps = 0;
  bool runs = true;
  double now_s = 100;
  Actions actions;
  Keys() {
    actions.add({"navigate.stop",
                 "Stop",
                 "",
                 GLFW_KEY_ESCAPE,
                 0,
                 false,
                 [this] { return runs; },
                 {},
                 [this] { ++stops; },
                 {"stop"}});
    actions.add(
        {"navigate.clear", "Clear", "", GLFW_KEY_C, 0, false, {}, {}, [this] { ++clears; }, {"clear"}});
    actions.add({"navigate.next", "Next", "", GLFW_KEY_SPACE, 0, false, {}, {}, [this] { ++steps; }});
    actions.add({"app.quit",
                 "Quit",
                 "",
                 GLFW_KEY_Q,
                 GLFW_MOD_CONTROL,
                 false,
                 {},
                 {},
                 [this] { ++stops; },
                 {"quit", [this] { return runs; }}});
    frame();
  }
  void frame(double length_s = 0.02) { actions.advance(now_s += length_s); }
  void frames_for(double time_s) {
    for (double t = 0; t < time_s - 1e-9; t += 0.02) frame();
  }
  void press(int key, int mods = 0) { actions.press({key, mods, false}, {"navigate.", "app."}); }
  void repeat(int key) { actions.press({key, 0, true}, {"navigate.", "app."}); }
};

// A key that ends something works when it is held, once, and not before 0.7 s.
TEST(GuardedKeyHazard22, EndsOnlyAfterItWasHeld) {
  Keys keys;
  keys.press(GLFW_KEY_ESCAPE);
  keys.frames_for(0.68);
  EXPECT_EQ(keys.stops, 0);
  EXPECT_GT(keys.actions.hold_progress("navigate.stop"), 0.9);
  keys.frames_for(0.06);
  EXPECT_EQ(keys.stops, 1);
  for (int i = 0; i < 50; ++i) {  // and the hand stays on it
    keys.repeat(GLFW_KEY_ESCAPE);
    keys.frame();
  }
  EXPECT_EQ(keys.stops, 1);
  keys.actions.release(GLFW_KEY_ESCAPE);
  keys.frame();
  EXPECT_TRUE(keys.actions.hold_words().empty());
}

// A short press does nothing and says what to do, for a while.
TEST(GuardedKeyHazard22, AShortPressSaysWhatToDo) {
  Keys keys;
  keys.press(GLFW_KEY_ESCAPE);
  keys.frames_for(0.1);
  keys.actions.release(GLFW_KEY_ESCAPE);
  keys.frame();
  EXPECT_EQ(keys.actions.hold_words(), "Hold Esc to stop");
  EXPECT_FALSE(keys.actions.is_held());
  keys.frames_for(HoldGuard::kReminder_s + 0.1);
  EXPECT_EQ(keys.actions.hold_words(), "");
  EXPECT_EQ(keys.stops, 0);
}

// Presses that follow each other do not add up.
TEST(GuardedKeyHazard22, ManyShortPressesAreNoLongOne) {
  Keys keys;
  for (int i = 0; i < 20; ++i) {
    keys.press(GLFW_KEY_ESCAPE);
    keys.frames_for(0.2);
    keys.actions.release(GLFW_KEY_ESCAPE);
    keys.frame();
  }
  EXPECT_EQ(keys.stops, 0);
}

// A screen that stood still for two seconds has not seen a hold, however long the key was down.
TEST(GuardedKeyHazard22, AFrozenScreenMakesNoLongPress) {
  Keys keys;
  keys.press(GLFW_KEY_ESCAPE);
  keys.frame();
  keys.frame(2.0);
  EXPECT_EQ(keys.stops, 0);
  keys.actions.release(GLFW_KEY_ESCAPE);
  keys.frame();
  EXPECT_EQ(keys.stops, 0);
  // A slow one, three frames a second, still lets it be held.
  keys.press(GLFW_KEY_ESCAPE);
  for (int i = 0; i < 4; ++i) keys.frame(0.33);
  EXPECT_EQ(keys.stops, 1);
}

// A hand that lies on the keyboard, a modifier let go, an action that is not possible any more: not done.
TEST(GuardedKeyHazard22, AnythingBetweenLetsGo) {
  Keys keys;
  keys.press(GLFW_KEY_ESCAPE);
  keys.frames_for(0.4);
  keys.press(GLFW_KEY_C);
  keys.frames_for(0.5);
  EXPECT_EQ(keys.stops + keys.clears, 0);
  keys.actions.release(GLFW_KEY_ESCAPE);  // not the key that is held now
  keys.frames_for(0.3);
  EXPECT_EQ(keys.clears, 1);
  keys.press(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  keys.frames_for(0.4);
  keys.actions.release(GLFW_KEY_LEFT_CONTROL);
  keys.frames_for(1);
  EXPECT_EQ(keys.stops, 0);
  keys.press(GLFW_KEY_ESCAPE);
  keys.frames_for(0.4);
  keys.runs = false;
  keys.frames_for(1);
  EXPECT_EQ(keys.stops, 0);
}

// What ends nothing answers to a press; what is guarded only while something runs, likewise after that.
TEST(GuardedKeyHazard22, OtherKeysAnswerAtOnce) {
  Keys keys;
  keys.press(GLFW_KEY_SPACE);
  EXPECT_EQ(keys.steps, 1);
  keys.runs = false;
  keys.press(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  EXPECT_EQ(keys.stops, 1);
}

// A button is held like its key; the pointer that leaves it lets go.
TEST(GuardedKeyHazard22, ButtonsAreHeldToo) {
  Keys keys;
  keys.actions.press_button("navigate.stop");
  keys.frames_for(0.5);
  keys.actions.release_button("navigate.stop");
  keys.frames_for(1);
  EXPECT_EQ(keys.stops, 0);
  keys.actions.press_button("navigate.stop");
  keys.frames_for(0.8);
  EXPECT_EQ(keys.stops, 1);
}

}  // namespace
}  // namespace arthronaut::widgets
