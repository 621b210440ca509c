#include "app/widgets/key_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace arthronaut::widgets {
namespace {

using Kind = KeyEvent::Kind;

class KeyQueueTest : public ::testing::Test {
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
    std::vector<KeyEvent> frame;
    for (int frames = 0; !queue_.is_empty(); ++frames) {
      EXPECT_LT(frames, 100);
      queue_.take_frame(frame, true);
      for (const KeyEvent& event : frame)
        if (event.kind == Kind::Text) text += static_cast<char>(event.codepoint);
      for (const KeyEvent& event : frame) {
        const bool is_let_go = std::count_if(frame.begin(), frame.end(), [&](const KeyEvent& other) {
          return other.kind == Kind::Release && other.key == event.key;
        });
        if (event.kind == Kind::Press && !is_let_go && event.key == GLFW_KEY_BACKSPACE && !text.empty())
          text.pop_back();
      }
    }
    return text;
  }
  KeyQueue queue_;
};

// However much comes between two frames, nothing is lost and nothing overtakes.
TEST_F(KeyQueueTest, KeepsEveryKeyAndTheirOrder) {
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
TEST_F(KeyQueueTest, AShortcutIsSeenWhole) {
  queue_.add({Kind::Press, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  tap(GLFW_KEY_A, GLFW_MOD_CONTROL);
  queue_.add({Kind::Release, GLFW_KEY_LEFT_CONTROL, 0, 0, 0});
  std::vector<KeyEvent> frame;
  queue_.take_frame(frame, true);
  ASSERT_EQ(frame.size(), 2U);
  EXPECT_EQ(frame[1].key, GLFW_KEY_A);
  queue_.take_frame(frame, true);
  EXPECT_EQ(frame.size(), 2U);
  EXPECT_TRUE(queue_.is_empty());
}

// A held key's repeats all belong to one frame, however slow the frames are.
TEST_F(KeyQueueTest, RepeatsDoNotQueueUp) {
  queue_.add({Kind::Press, GLFW_KEY_RIGHT, 0, 0, 0});
  for (int i = 0; i < 5; ++i) queue_.add({Kind::Repeat, GLFW_KEY_RIGHT, 0, 0, 0});
  std::vector<KeyEvent> frame;
  queue_.take_frame(frame, true);
  EXPECT_EQ(frame.size(), 6U);
  EXPECT_TRUE(queue_.is_empty());
}

// Letters typed fast do not take a frame each.
TEST_F(KeyQueueTest, DifferentLettersShareAFrame) {
  for (const char letter : {'k', 'n', 'e'}) type(letter);
  std::vector<KeyEvent> frame;
  queue_.take_frame(frame, true);
  long letters = 0;
  for (const KeyEvent& event : frame) letters += event.kind == Kind::Text ? 1 : 0;
  EXPECT_GE(letters, 1);
  EXPECT_EQ(played().size() + static_cast<std::size_t>(letters), 3U);
}

// A key that is held until a field opens writes nothing into it, however long it is held on; pressed once
// more, in the field, it is a letter like any other.
TEST_F(KeyQueueTest, TheKeyThatOpenedAFieldWritesNothingIntoIt) {
  std::vector<KeyEvent> frame;
  const auto letters = [&] {
    return std::count_if(frame.begin(), frame.end(),
                         [](const KeyEvent& event) { return event.kind == Kind::Text; });
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
