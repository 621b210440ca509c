// What belongs to the room and not to a case: the screen's size, which key or pedal does what. One file,
// written by hand:
//
//   {
//     "format": "arthronaut.theatre", "version": 1,
//     "screen_diagonal_in": 27,
//     "screen_stream": "udp://10.0.0.9:5004",
//     "igtl_port": 18944, "igtl_network": false,
//     "foot_switches": ["/dev/input/by-id/usb-PCsensor_FootSwitch-event-kbd"],
//     "pedals": { "do_it": ["KEY_B"], "back": ["KEY_A"], "overlay": ["KEY_C", "59"] },
//     "keys": { "do_it": ["F8"], "back": ["B"], "overlay": [] }
//   }
//
// Everything in it may be left out. Codes of pedals are those of the kernel (linux/input-event-codes.h), by
// name or number; keys are named as the key list names them. Space, Page up and V do what they do in any
// case: a file that is wrong leaves nobody without a pedal.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace arthronaut::pedals {

enum class Pedal { DoIt, Back, Overlay };
// The key whose meaning a pedal has: Space, Page up, V (GLFW_KEY_*).
[[nodiscard]] int key_of(Pedal pedal);

struct TheatreSettings {
  std::optional<double> screen_diagonal_in;
  std::string screen_stream;  // where the screen is sent to when somebody asks for it; empty: nowhere
  int igtl_port = -1;         // where other programs get poses by OpenIGTLink (0: any free one); -1: nowhere
  bool igtl_network = false;  // to other machines, too, and not to this one alone
  // Devices that are pedals. Empty: every input device whose name says that it is a pedal or a foot switch.
  std::vector<std::filesystem::path> foot_switches;
  std::map<int, Pedal> codes;  // of the kernel's events
  std::map<int, Pedal> keys;   // GLFW_KEY_*; such a key loses its own meaning
};
// Pedals from left to right as foot switches come from the factory: A is back, B is do it, C is the overlay.
[[nodiscard]] TheatreSettings usual_settings();

// $XDG_CONFIG_HOME/arthronaut/theatre.json, else ~/.config/...
[[nodiscard]] std::filesystem::path theatre_settings_file();
// The usual ones where there is no such file. Throws InvalidInput ("FILE: pedals.do_it: ...") for one that is
// wrong: unknown names, one code for two pedals, a screen that is no screen; IoError when it can't be read.
[[nodiscard]] TheatreSettings load_theatre_settings(const std::filesystem::path& file);

}  // namespace arthronaut::pedals
