#include "app/pedals/theatre_settings.h"

#include <GLFW/glfw3.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/widgets/actions.h"
#include "planning/files/json_document.h"

namespace arthronaut::pedals {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kFormat = "arthronaut.theatre";
constexpr int kVersion = 1;
constexpr std::array<std::pair<const char*, Pedal>, 3> kPedals{
    {{"do_it", Pedal::DoIt}, {"back", Pedal::Back}, {"overlay", Pedal::Overlay}}};

// What foot switches send: letters, digits and function keys as a keyboard, buttons as a mouse.
std::optional<int> code_from_name(const std::string& name) {
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && end == name.data() + name.size())
    return number > 0 && number <= KEY_MAX ? std::optional(number) : std::nullopt;
  static const std::map<std::string, int> kCodes{{"KEY_A", KEY_A},
                                                 {"KEY_B", KEY_B},
                                                 {"KEY_C", KEY_C},
                                                 {"KEY_D", KEY_D},
                                                 {"KEY_E", KEY_E},
                                                 {"KEY_F", KEY_F},
                                                 {"KEY_G", KEY_G},
                                                 {"KEY_H", KEY_H},
                                                 {"KEY_I", KEY_I},
                                                 {"KEY_J", KEY_J},
                                                 {"KEY_K", KEY_K},
                                                 {"KEY_L", KEY_L},
                                                 {"KEY_M", KEY_M},
                                                 {"KEY_N", KEY_N},
                                                 {"KEY_O", KEY_O},
                                                 {"KEY_P", KEY_P},
                                                 {"KEY_Q", KEY_Q},
                                                 {"KEY_R", KEY_R},
                                                 {"KEY_S", KEY_S},
                                                 {"KEY_T", KEY_T},
                                                 {"KEY_U", KEY_U},
                                                 {"KEY_V", KEY_V},
                                                 {"KEY_W", KEY_W},
                                                 {"KEY_X", KEY_X},
                                                 {"KEY_Y", KEY_Y},
                                                 {"KEY_Z", KEY_Z},
                                                 {"KEY_1", KEY_1},
                                                 {"KEY_2", KEY_2},
                                                 {"KEY_3", KEY_3},
                                                 {"KEY_F1", KEY_F1},
                                                 {"KEY_F2", KEY_F2},
                                                 {"KEY_F3", KEY_F3},
                                                 {"KEY_F13", KEY_F13},
                                                 {"KEY_F14", KEY_F14},
                                                 {"KEY_F15", KEY_F15},
                                                 {"KEY_SPACE", KEY_SPACE},
                                                 {"KEY_ENTER", KEY_ENTER},
                                                 {"KEY_PAGEUP", KEY_PAGEUP},
                                                 {"KEY_PAGEDOWN", KEY_PAGEDOWN},
                                                 {"KEY_LEFT", KEY_LEFT},
                                                 {"KEY_RIGHT", KEY_RIGHT},
                                                 {"BTN_LEFT", BTN_LEFT},
                                                 {"BTN_RIGHT", BTN_RIGHT},
                                                 {"BTN_MIDDLE", BTN_MIDDLE},
                                                 {"BTN_0", BTN_0},
                                                 {"BTN_1", BTN_1},
                                                 {"BTN_2", BTN_2}};
  const auto found = kCodes.find(name);
  return found == kCodes.end() ? std::nullopt : std::optional(found->second);
}

std::optional<int> key_from_name(const std::string& name) {
  for (int key = GLFW_KEY_SPACE; key <= GLFW_KEY_LAST; ++key)
    if (!name.empty() && widgets::key_name(key, 0) == name) return key;
  return std::nullopt;
}

template <typename FromName>
std::map<int, Pedal> read_map(const files::JsonObject& json, const FromName& from_name) {
  std::map<int, Pedal> map;
  for (const auto& [name, pedal] : kPedals) {
    if (!json.has(name)) continue;
    for (const std::string& text : json.texts(name)) {
      const std::optional<int> code = from_name(text);
      if (!code) json.fail(name, "\"" + text + "\" is no key that is known");
      if (const auto [known, is_new] = map.emplace(*code, pedal); !is_new)
        json.fail(name, "\"" + text + "\" stands for two things");
    }
  }
  return map;
}

}  // namespace

int key_of(Pedal pedal) {
  return pedal == Pedal::DoIt ? GLFW_KEY_SPACE : pedal == Pedal::Back ? GLFW_KEY_PAGE_UP : GLFW_KEY_V;
}

TheatreSettings usual_settings() {
  TheatreSettings settings;
  settings.codes = {{KEY_A, Pedal::Back},       {KEY_B, Pedal::DoIt},     {KEY_C, Pedal::Overlay},
                    {KEY_PAGEUP, Pedal::Back},  {KEY_SPACE, Pedal::DoIt}, {KEY_V, Pedal::Overlay},
                    {KEY_PAGEDOWN, Pedal::DoIt}};
  settings.keys = {{GLFW_KEY_PAGE_DOWN, Pedal::DoIt}};
  return settings;
}

fs::path theatre_settings_file() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  const fs::path folder = config != nullptr && *config != '\0' ? fs::path(config)
                          : home != nullptr                    ? fs::path(home) / ".config"
                                                               : fs::path(".config");
  return folder / "arthronaut" / "theatre.json";
}

TheatreSettings load_theatre_settings(const fs::path& file) {
  TheatreSettings settings = usual_settings();
  std::error_code error;
  if (!fs::exists(file, error)) return settings;
  const files::JsonObject json = files::read_json(file, kFormat, kVersion);
  if (json.has("screen_diagonal_in")) {
    settings.screen_diagonal_in = json.positive_number("screen_diagonal_in");
    constexpr double kSmallest_in = 5, kLargest_in = 200;
    if (*settings.screen_diagonal_in < kSmallest_in || *settings.screen_diagonal_in > kLargest_in)
      json.fail("screen_diagonal_in", "is not from 5 to 200 inches");
  }
  if (json.has("screen_stream")) {
    settings.screen_stream = json.text("screen_stream");
    if (!settings.screen_stream.starts_with("udp://") ||
        settings.screen_stream.find(':', 6) == std::string::npos)
      json.fail("screen_stream", "must be udp://HOST:PORT, is \"" + settings.screen_stream + "\"");
  }
  if (json.has("igtl_port")) {
    settings.igtl_port = json.int32("igtl_port");
    constexpr int kLastPort = 65535;
    if (settings.igtl_port < 0 || settings.igtl_port > kLastPort)
      json.fail("igtl_port", "is no port from 0 to 65535");
  }
  if (json.has("igtl_network")) settings.igtl_network = json.boolean("igtl_network");
  if (json.has("foot_switches"))
    for (const std::string& path : json.texts("foot_switches")) settings.foot_switches.emplace_back(path);
  if (json.has("pedals")) settings.codes = read_map(json.object("pedals"), code_from_name);
  if (json.has("keys")) {
    settings.keys = read_map(json.object("keys"), key_from_name);
    for (const auto& [name, pedal] : kPedals)
      if (const auto taken = settings.keys.find(key_of(pedal));
          taken != settings.keys.end() && taken->second != pedal)
        json.fail("keys", "Space, Page up and V keep their meaning");
  }
  return settings;
}

}  // namespace arthronaut::pedals
