#include "app/training/hand_devices.h"

#include <gtest/gtest.h>

namespace arthronaut::training_mode {
namespace {

using Eigen::Vector3d;
using simulator::HandInput;
using simulator::Held;

constexpr double kFrame_s = 0.05;

TEST(HandDevices, NothingPushedIsNothing) {
  const HandInput input = hand_input({}, Held::Guide, kFrame_s);
  EXPECT_EQ(input.held, Held::Guide);
  EXPECT_TRUE(input.move.isZero());
  EXPECT_TRUE(input.tilt.isZero());
  EXPECT_EQ(input.drill, 0);
  EXPECT_FALSE(input.moves_scope);
}

// The same way on the table is the same push, however often the devices are read.
TEST(HandDevices, MouseCountsBySpeed) {
  DeviceState slow, fast;
  slow.mouse_moves = fast.mouse_moves = true;
  slow.mouse_px = {10, -5};
  fast.mouse_px = {20, -10};
  EXPECT_EQ(hand_input(slow, Held::Probe, kFrame_s).move, hand_input(fast, Held::Probe, 2 * kFrame_s).move);
  EXPECT_GT(hand_input(slow, Held::Probe, kFrame_s).move.x(), 0);
  EXPECT_LT(hand_input(slow, Held::Probe, kFrame_s).move.y(), 0);
  EXPECT_TRUE(hand_input(slow, Held::Probe, 0).move.isZero());
}

// Which button is held says what moves; without one the mouse is anybody's.
TEST(HandDevices, ButtonsChooseWhatMoves) {
  DeviceState state;
  state.mouse_px = {10, 0};
  EXPECT_TRUE(hand_input(state, Held::Probe, kFrame_s).move.isZero());
  state.mouse_tilts = true;
  EXPECT_TRUE(hand_input(state, Held::Probe, kFrame_s).move.isZero());
  EXPECT_GT(hand_input(state, Held::Probe, kFrame_s).tilt.x(), 0);
  state.mouse_tilts = false;
  state.mouse_scope = true;
  EXPECT_TRUE(hand_input(state, Held::Probe, kFrame_s).moves_scope);
  EXPECT_GT(hand_input(state, Held::Probe, kFrame_s).move.x(), 0);
}

// For the last millimetre: a quarter of the speed, by whatever device, and never more than that.
TEST(HandDevices, BMovesFinely) {
  DeviceState keys;
  keys.keys_move = {1, 0, 0};
  keys.keys_tilt = {0, -1, 0};
  keys.mouse_px = {400, 0};  // far beyond the full speed
  keys.mouse_moves = true;
  keys.is_fine = true;
  const HandInput input = hand_input(keys, Held::Guide, kFrame_s);
  EXPECT_DOUBLE_EQ(input.move.x(), 0.25);
  EXPECT_DOUBLE_EQ(input.tilt.y(), -0.25);
}

// Pedal and Enter are pressed while one moves finely: with a modifier held they would be other keys, and what
// Alt drags is the window manager's. Shift alone is held for the scope.
TEST(HandDevices, NoModifierIsHeldForFineMoves) {
  bool says_fine = false;
  for (const mode::HeldKeys& held : keys_of_the_hands()) {
    says_fine |= held.keys == "B" && held.words.find("quarter of the speed") != std::string::npos;
    EXPECT_EQ(held.keys.find("Alt"), std::string::npos);
    EXPECT_EQ(held.keys.find("Ctrl"), std::string::npos);
  }
  EXPECT_TRUE(says_fine);
}

// The lens of the scope can be turned by every device: the wheel does with the right button, and is then no
// way nearer or away.
TEST(HandDevices, EveryDeviceTurnsTheLens) {
  DeviceState keys;
  keys.keys_lens = 1;
  EXPECT_EQ(hand_input(keys, Held::Board, kFrame_s).turn_lens, 1);
  DeviceState mouse;
  mouse.wheel = 1;
  EXPECT_EQ(hand_input(mouse, Held::Board, kFrame_s).turn_lens, 0);
  EXPECT_GT(hand_input(mouse, Held::Board, kFrame_s).move.z(), 0);
  mouse.mouse_tilts = true;
  EXPECT_GT(hand_input(mouse, Held::Board, kFrame_s).turn_lens, 0);
  EXPECT_EQ(hand_input(mouse, Held::Board, kFrame_s).move.z(), 0);
  DeviceState pad;
  pad.pad_lens = -1;
  EXPECT_EQ(hand_input(pad, Held::Board, kFrame_s).turn_lens, 0);
  pad.has_pad = true;
  EXPECT_EQ(hand_input(pad, Held::Board, kFrame_s).turn_lens, -1);
}

// A thumb that rests on a stick pushes nothing; a full stick pushes fully; a pad that is not there nothing.
TEST(HandDevices, SticksHaveARest) {
  DeviceState state;
  state.has_pad = true;
  state.pad_move = {0.1, -0.12, 0};
  EXPECT_TRUE(hand_input(state, Held::Probe, kFrame_s).move.isZero());
  state.pad_move = {1, -1, 0.5};
  const Vector3d move = hand_input(state, Held::Probe, kFrame_s).move;
  EXPECT_DOUBLE_EQ(move.x(), 1);
  EXPECT_DOUBLE_EQ(move.y(), -1);
  EXPECT_GT(move.z(), 0.3);
  EXPECT_LT(move.z(), 0.5);
  state.pad_drill = true;
  EXPECT_EQ(hand_input(state, Held::Guide, kFrame_s).drill, 1);
  state.has_pad = false;
  EXPECT_TRUE(hand_input(state, Held::Guide, kFrame_s).move.isZero());
  EXPECT_EQ(hand_input(state, Held::Guide, kFrame_s).drill, 0);
}

}  // namespace
}  // namespace arthronaut::training_mode
