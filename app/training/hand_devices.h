// Keyboard, mouse and gamepad as a trainee's hands: what is held down, moved and tilted becomes a push of
// simulator::HandControl. The mapping is pure; the devices are read by the calls below alone.
//
//   keyboard  A D, W S, Q E: the tool left and right, up and down, nearer and away; J L, I K, U O: its handle
//             likewise; Shift: the scope instead; B: finely; Z X: the lens; F: the drill
//   mouse     left button: the tool; right button: its handle; middle button: the scope; the wheel: nearer
//             and away, with the right button held: the lens
//   gamepad   left stick, triggers: the tool; right stick, D-pad up and down: its handle; D-pad left and
//             right: the lens; left bumper: the scope instead; right bumper: the drill
//
// The calibration board is a tool like the others, and the side that faces the lens its handle.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "app/mode/mode.h"
#include "navigation/simulator/hand_control.h"

namespace arthronaut::training_mode {

// From -1 to 1 on each axis: right, down, away from the lens.
struct DeviceState {
  Eigen::Vector3d keys_move = Eigen::Vector3d::Zero(), keys_tilt = Eigen::Vector3d::Zero();
  double keys_lens = 0;
  bool keys_scope = false, keys_drill = false;
  bool is_fine = false;                                // everything moves and tilts at a quarter of the speed
  Eigen::Vector2d mouse_px = Eigen::Vector2d::Zero();  // since the last reading; at a window 1080 pixels high
  double wheel = 0;                                    // notches, up is above 0
  bool mouse_moves = false, mouse_tilts = false, mouse_scope = false;
  bool has_pad = false;
  Eigen::Vector3d pad_move = Eigen::Vector3d::Zero(), pad_tilt = Eigen::Vector3d::Zero();
  double pad_lens = 0;
  bool pad_scope = false, pad_drill = false;
};

// What the devices push together, over dt_s since the last reading. A stick near its middle pushes nothing.
[[nodiscard]] simulator::HandInput hand_input(const DeviceState& devices, simulator::Held held, double dt_s);

// The keyboard's, for the list of keys.
[[nodiscard]] std::vector<mode::HeldKeys> keys_of_the_hands();

// Pressed on the gamepad since the last reading.
struct PadPresses {
  bool do_it = false, back = false, other_tool = false, done = false;  // A, B, X, Start
};

// Of the window that is current; on its thread, within an ImGui frame. GLFW's own gamepads.
class HandDevices {
 public:
  // Keys and mouse count only while `window_height_px` is above 0 and no text field has them.
  [[nodiscard]] DeviceState read(float window_height_px);
  [[nodiscard]] PadPresses presses();
  // "gamepad Xbox Controller"; empty without one.
  [[nodiscard]] static std::string pad_name();

 private:
  unsigned pad_was_down_ = 0;
};

}  // namespace arthronaut::training_mode
