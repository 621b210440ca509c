// What belongs to the room that the workstation stands in: its settings, and its pedals as keys.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/pedals/foot_switch.h"
#include "app/widgets/actions.h"

namespace arthronaut::window {

class Room {
 public:
  // Reads the settings. A file that is wrong is told by trouble(), and the usual settings hold.
  Room();
  // The foot switches are read from now on. wake: called from another thread.
  void listen(std::function<void()> wake);

  [[nodiscard]] double screen_diagonal_mm() const;  // 0: nobody said
  [[nodiscard]] const std::string& screen_stream() const { return settings_.screen_stream; }
  [[nodiscard]] int igtl_port() const { return settings_.igtl_port; }
  [[nodiscard]] bool igtl_network() const { return settings_.igtl_network; }
  // The key whose meaning this key has: its own, unless the settings say otherwise.
  [[nodiscard]] int meaning_of(int key) const;
  // Pedals that were pressed or let go, as keys; while `is_typing`, presses of all but the way back are
  // nobody's.
  void press_pedals(widgets::Actions& actions, const std::vector<std::string_view>& prefixes, bool is_typing);

  // While they mean nothing: `pressed` is called where one was pressed.
  void drop_pedals(widgets::Actions& actions, const std::function<void()>& pressed);

  [[nodiscard]] std::string trouble() const;  // of the settings or of a foot switch; empty: none
  [[nodiscard]] std::string devices() const;  // that are read, by name; "none"

 private:
  pedals::TheatreSettings settings_;
  std::string settings_trouble_;
  std::unique_ptr<pedals::FootSwitch> foot_switch_;
};

}  // namespace arthronaut::window
