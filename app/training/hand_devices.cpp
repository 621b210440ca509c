#include "app/training/hand_devices.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace arthronaut::training_mode {

namespace {

using Eigen::Vector3d;

constexpr double kFullPx_s = 500;     // a mouse that is moved so fast pushes fully
constexpr double kFullNotches_s = 6;  // a wheel likewise
constexpr double kFine = 0.25;        // of the speed, with B held
constexpr double kRest = 0.15;        // of a stick: nobody's thumb is still

Vector3d without_rest(const Vector3d& axes) {
  return axes.unaryExpr([](double axis) {
    const double beyond = std::abs(axis) - kRest;
    return beyond > 0 ? std::copysign(std::min(1.0, beyond / (1 - kRest)), axis) : 0.0;
  });
}

double between(bool less, bool more) { return (more ? 1.0 : 0.0) - (less ? 1.0 : 0.0); }

int first_pad() {
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id)
    if (glfwJoystickPresent(id) == GLFW_TRUE && glfwJoystickIsGamepad(id) == GLFW_TRUE) return id;
  return -1;
}

bool read_pad(GLFWgamepadstate& pad) {
  const int id = first_pad();
  return id >= 0 && glfwGetGamepadState(id, &pad) == GLFW_TRUE;
}

}  // namespace

simulator::HandInput hand_input(const DeviceState& devices, simulator::Held held, double dt_s) {
  simulator::HandInput input;
  input.held = held;
  input.move = devices.keys_move;
  input.tilt = devices.keys_tilt;
  input.turn_lens = devices.keys_lens;
  input.moves_scope = devices.keys_scope;
  if (dt_s > 0) {
    const Vector3d mouse(devices.mouse_px.x() / (kFullPx_s * dt_s), devices.mouse_px.y() / (kFullPx_s * dt_s),
                         devices.wheel / (kFullNotches_s * dt_s));
    if (devices.mouse_tilts) {
      input.tilt += Vector3d(mouse.x(), mouse.y(), 0);
      input.turn_lens += mouse.z();
    } else if (devices.mouse_moves || devices.mouse_scope) {
      input.move += mouse;
    } else {
      input.move.z() += mouse.z();
    }
    input.moves_scope = input.moves_scope || devices.mouse_scope;
  }
  if (devices.has_pad) {
    input.move += without_rest(devices.pad_move);
    input.tilt += without_rest(devices.pad_tilt);
    input.turn_lens += devices.pad_lens;
    input.moves_scope = input.moves_scope || devices.pad_scope;
  }
  if (devices.is_fine) {
    // A push beyond the full one is cut off first: fine is a quarter of what the hand can do.
    const auto finely = [](const Vector3d& axes) { return Vector3d(kFine * axes.cwiseMax(-1).cwiseMin(1)); };
    input.move = finely(input.move);
    input.tilt = finely(input.tilt);
  }
  input.drill = devices.keys_drill || (devices.has_pad && devices.pad_drill) ? 1 : 0;
  return input;
}

std::vector<mode::HeldKeys> keys_of_the_hands() {
  return {
      {"A D W S", "The tool left, right, up and down; the mouse's left button does it, too"},
      {"Q E", "The tool nearer and away; the wheel does it, too"},
      {"J L I K", "Its handle left, right, up and down; the mouse's right button does it, too"},
      {"U O", "Its handle nearer and away"},
      {"Shift", "Held beside them: the scope instead of the tool; the mouse's middle button does it, too"},
      {"B", "Held beside them: a quarter of the speed, for the last millimetre"},
      {"Z X", "Turns the lens"},
      {"F", "Drills, while it is held"}};
}

DeviceState HandDevices::read(float window_height_px) {
  DeviceState state;
  const ImGuiIO& io = ImGui::GetIO();
  GLFWwindow* const window = glfwGetCurrentContext();
  if (window != nullptr && window_height_px > 0 && !io.WantTextInput) {
    const auto down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    state.keys_move = {between(down(GLFW_KEY_A), down(GLFW_KEY_D)),
                       between(down(GLFW_KEY_W), down(GLFW_KEY_S)),
                       between(down(GLFW_KEY_Q), down(GLFW_KEY_E))};
    state.keys_tilt = {between(down(GLFW_KEY_J), down(GLFW_KEY_L)),
                       between(down(GLFW_KEY_I), down(GLFW_KEY_K)),
                       between(down(GLFW_KEY_U), down(GLFW_KEY_O))};
    state.keys_lens = between(down(GLFW_KEY_Z), down(GLFW_KEY_X));
    state.keys_scope = io.KeyShift;
    state.keys_drill = down(GLFW_KEY_F);
    // No modifier: Space and Enter are to be pressed beside it, and window managers take what Alt drags.
    state.is_fine = down(GLFW_KEY_B);
    const double scale = 1080.0 / window_height_px;
    state.mouse_px = {scale * io.MouseDelta.x, scale * io.MouseDelta.y};
    state.wheel = io.MouseWheel;
    state.mouse_moves = io.MouseDown[0];
    state.mouse_tilts = io.MouseDown[1];
    state.mouse_scope = io.MouseDown[2];
  }
  GLFWgamepadstate pad;
  if (!read_pad(pad)) return state;
  state.has_pad = true;
  const auto axis = [&](int which) { return static_cast<double>(pad.axes[which]); };
  const auto is_down = [&](int which) { return pad.buttons[which] == GLFW_PRESS; };
  // Triggers rest at -1.
  state.pad_move = {axis(GLFW_GAMEPAD_AXIS_LEFT_X), axis(GLFW_GAMEPAD_AXIS_LEFT_Y),
                    (axis(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER) - axis(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER)) / 2};
  state.pad_tilt = {axis(GLFW_GAMEPAD_AXIS_RIGHT_X), axis(GLFW_GAMEPAD_AXIS_RIGHT_Y),
                    between(is_down(GLFW_GAMEPAD_BUTTON_DPAD_DOWN), is_down(GLFW_GAMEPAD_BUTTON_DPAD_UP))};
  state.pad_lens = between(is_down(GLFW_GAMEPAD_BUTTON_DPAD_LEFT), is_down(GLFW_GAMEPAD_BUTTON_DPAD_RIGHT));
  state.pad_scope = is_down(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER);
  state.pad_drill = is_down(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER);
  return state;
}

PadPresses HandDevices::presses() {
  GLFWgamepadstate pad;
  unsigned down = 0;
  if (read_pad(pad))
    for (int i = 0; i <= GLFW_GAMEPAD_BUTTON_LAST; ++i)
      if (pad.buttons[i] == GLFW_PRESS) down |= 1U << static_cast<unsigned>(i);
  const unsigned fresh = down & ~pad_was_down_;
  pad_was_down_ = down;
  const auto was = [&](int button) { return ((fresh >> static_cast<unsigned>(button)) & 1U) != 0; };
  return {was(GLFW_GAMEPAD_BUTTON_A), was(GLFW_GAMEPAD_BUTTON_B), was(GLFW_GAMEPAD_BUTTON_X),
          was(GLFW_GAMEPAD_BUTTON_START)};
}

std::string HandDevices::pad_name() {
  const int id = first_pad();
  if (id < 0) return "";
  const char* const name = glfwGetGamepadName(id);
  return "gamepad " + std::string(name != nullptr ? name : "");
}

}  // namespace arthronaut::training_mode
