#include "app/widgets/input_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace arthronaut::widgets {
namespace {

using Kind = InputEvent::Kind;

class InputQueueTest : public ::testing::Test {
 protected:
  void tap(int key, int mods = 0) {
    queue_.add({Kind::Press, key, 0, mods, 0});
    queue_.add({Kind::Release, key, 0, mods, 0});
  }
  void type(char letter) {
    queue_.add({Kind::Press, GLFW_KEY_A + (letter - 'a'), 0, 0, 0});
    queue_.add({Kind::Text, 0, 0, 0, static_cast<unsigned>(letter)});
    queue_.add({Kind::Release, GLFW_KEY_A + (letter - 'a'), 0, 0, 0});
  }
  // What a text field makes of the frames: letters first, as ImGui does, then the keys that are down.
  std::string played() {
    std::string text;
    std::vector<InputEvent> frame;
    for (int frames = 0; !queue_.is_empty(); ++frames) {
      EXPECT_LT(frames, 100);
      queue_.take_frame(frame, true);
      for (const InputEvent& event : frame)
        if (event.kind == Kind::Text) text += static_cast<char>(event.codepoint);
      for (const InputEvent& event : frame) {
        const bool is_let_go = std::count_if(frame.begin(), frame.end(), [&](const InputEvent& other) {
          return other.kind == Kind::Release && other.key == event.key;
        });
        if (event.kind == Kind::Press && !is_let_go && event.key == GLFW_KEY_BACKSPACE && !text.empty())
          text.pop_back();
      }
    }
    return text;
  }
  InputQueue queue_;
};

// However much comes between two frames, nothing is lost and nothing overtakes.
TEST_F(InputQueueTest, KeepsEveryKeyAndTheirOrder) {
  type('a');
  type('b');
  type('x');
  tap(GLFW_KEY_BACKSPACE);
  type('c');
  type('y');
  tap(GLFW_KEY_BACKSPACE);
  tap(GLFW_KEY_BACKSPACE);
  type('d');
  EXPECT_EQ(played(), "abd");
}

// A key stays down for a frame, with the modifier that it was pressed with.
TEST_F(InputQueueTest, AShortcutIsSeenWhole) {
  queue_.add({Kind::Press, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  tap(GLFW_KEY_A, GLFW_MOD_CONTROL);
  queue_.add({Kind::Release, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  std::vector<InputEvent> frame;
  queue_.take_frame(frame, true);
  ASSERT_EQ(frame.size(), 2U);
  EXPECT_EQ(frame[1].key, GLFW_KEY_A);
  queue_.take_frame(frame, true);
  EXPECT_EQ(frame.size(), 2U);
  EXPECT_TRUE(queue_.is_empty());
}

// A held key's repeats all belong to one frame, however slow the frames are.
TEST_F(InputQueueTest, RepeatsDoNotQueueUp) {
  queue_.add({Kind::Press, GLFW_KEY_RIGHT, 0, 0, 0});
  for (int i = 0; i < 5; ++i) queue_.add({Kind::Repeat, GLFW_KEY_RIGHT, 0, 0, 0});
  std::vector<InputEvent> frame;
  queue_.take_frame(frame, true);
  EXPECT_EQ(frame.size(), 6U);
  EXPECT_TRUE(queue_.is_empty());
}

// Letters typed fast do not take a frame each: not where they come twice, and not capitals.
TEST_F(InputQueueTest, ABurstOfLettersIsOneFrames) {
  for (const char letter : {'k', 'n', 'e', 'e'}) type(letter);
  queue_.add({Kind::Press, GLFW_KEY_LEFT_SHIFT, 0, 0, 0});
  queue_.add({Kind::Press, GLFW_KEY_L, 0, GLFW_MOD_SHIFT, 0});
  queue_.add({Kind::Text, 0, 0, 0, 'L'});
  queue_.add({Kind::Release, GLFW_KEY_L, 0, GLFW_MOD_SHIFT, 0});
  queue_.add({Kind::Release, GLFW_KEY_LEFT_SHIFT, 0, 0, 0});
  std::vector<InputEvent> frame;
  queue_.take_frame(frame, true);
  EXPECT_TRUE(queue_.is_empty());
  EXPECT_EQ(std::count_if(frame.begin(), frame.end(),
                          [](const InputEvent& event) { return event.kind == Kind::Text; }),
            5);
}

// Where no field has the keys the same letters are commands, and each is seen down for a frame.
TEST_F(InputQueueTest, CommandsAreSeenDown) {
  for (const char letter : {'k', 'n'}) type(letter);
  std::vector<InputEvent> frame;
  queue_.take_frame(frame, false);
  EXPECT_FALSE(queue_.is_empty());
  for (const InputEvent& event : frame) EXPECT_NE(event.kind, Kind::Release);
}

// A click comes after the letters that were typed before it and before those after it; its press is seen for
// a frame, at the place where the cursor was then.
TEST_F(InputQueueTest, AClickKeepsItsTurnAndItsPlace) {
  type('a');
  queue_.add({Kind::ButtonPress, GLFW_MOUSE_BUTTON_LEFT, 0, 0, 0, {30, 40}});
  queue_.add({Kind::ButtonRelease, GLFW_MOUSE_BUTTON_LEFT, 0, 0, 0, {31, 40}});
  type('b');
  std::vector<std::vector<InputEvent>> frames;
  while (!queue_.is_empty()) {
    ASSERT_LT(frames.size(), 10U);
    queue_.take_frame(frames.emplace_back(), true);
  }
  ASSERT_EQ(frames.size(), 4U);
  for (const InputEvent& event : frames[0]) EXPECT_FALSE(is_of_mouse(event));
  ASSERT_EQ(frames[1].size(), 1U);
  EXPECT_EQ(frames[1][0].kind, Kind::ButtonPress);
  EXPECT_EQ(frames[1][0].place.x_px, 30);
  ASSERT_EQ(frames[2].size(), 1U);
  EXPECT_EQ(frames[2][0].kind, Kind::ButtonRelease);
  EXPECT_EQ(frames[2][0].place.x_px, 31);
  EXPECT_EQ(frames[3].size(), 3U);
}

// A click's modifier is down when the click is looked at, and the wheel is turned before what is clicked on
// after it.
TEST_F(InputQueueTest, AClickSeesItsModifierAndTheTurnedList) {
  queue_.add({Kind::Press, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  queue_.add({Kind::ButtonPress, GLFW_MOUSE_BUTTON_LEFT, 0, GLFW_MOD_CONTROL, 0, {1, 1}});
  queue_.add({Kind::Release, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  std::vector<InputEvent> frame;
  queue_.take_frame(frame, false);
  EXPECT_EQ(frame.size(), 2U);
  queue_.take_frame(frame, false);
  EXPECT_EQ(frame.size(), 1U);
  for (int i = 0; i < 3; ++i) queue_.add({Kind::Wheel, 0, 0, 0, 0, {1, 1}, 0, 1});
  queue_.add({Kind::ButtonPress, GLFW_MOUSE_BUTTON_LEFT, 0, 0, 0, {1, 1}});
  queue_.take_frame(frame, false);
  EXPECT_EQ(frame.size(), 3U);
  EXPECT_TRUE(queue_.waits_with_mouse());
}

// A key that is held until a field opens writes nothing into it, however long it is held on; pressed once
// more, in the field, it is a letter like any other.
// A key that is held while the wheel turns: its release is not kept back by one frame a turn.
TEST_F(InputQueueTest, AHeldKeyAndTheWheelDoNotWaitForEachOther) {
  queue_.add({Kind::Press, GLFW_KEY_F, 0, 0, 0});
  for (int i = 0; i < 20; ++i) {
    queue_.add({Kind::Repeat, GLFW_KEY_F, 0, 0, 0});
    queue_.add({.kind = Kind::Wheel, .wheel_y = 1});
  }
  queue_.add({Kind::Release, GLFW_KEY_F, 0, 0, 0});
  std::vector<InputEvent> frame;
  int frames = 0;
  for (; !queue_.is_empty() && frames < 50; ++frames) queue_.take_frame(frame, false);
  EXPECT_LE(frames, 3);
}

TEST_F(InputQueueTest, TheKeyThatOpenedAFieldWritesNothingIntoIt) {
  std::vector<InputEvent> frame;
  const auto letters = [&] {
    return std::count_if(frame.begin(), frame.end(),
                         [](const InputEvent& event) { return event.kind == Kind::Text; });
  };
  const auto repeat = [&] {
    queue_.add({Kind::Repeat, GLFW_KEY_K, 0, 0, 0});
    queue_.add({Kind::Text, 0, 0, 0, 'k'});
  };
  queue_.add({Kind::Press, GLFW_KEY_K, 0, 0, 0});
  queue_.add({Kind::Text, 0, 0, 0, 'k'});
  queue_.take_frame(frame, false);
  for (int i = 0; i < 3; ++i) {
    repeat();
    queue_.take_frame(frame, true);
    EXPECT_EQ(letters(), 0);
    EXPECT_TRUE(queue_.is_empty());
  }
  queue_.add({Kind::Release, GLFW_KEY_K, 0, 0, 0});
  queue_.take_frame(frame, true);
  queue_.add({Kind::Press, GLFW_KEY_K, 0, 0, 0});
  queue_.add({Kind::Text, 0, 0, 0, 'k'});
  repeat();
  queue_.take_frame(frame, true);
  EXPECT_EQ(letters(), 2);
}

}  // namespace
}  // namespace arthronaut::widgets
