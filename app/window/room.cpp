#include "app/window/room.h"

#include <stdexcept>
#include <utility>

namespace arthronaut::window {

Room::Room() {
  try {
    settings_ = pedals::load_theatre_settings(pedals::theatre_settings_file());
  } catch (const std::runtime_error& error) {
    settings_ = pedals::usual_settings();
    settings_trouble_ = error.what();
  }
}

void Room::listen(std::function<void()> wake) {
  foot_switch_ = std::make_unique<pedals::FootSwitch>(settings_, std::move(wake));
}

double Room::screen_diagonal_mm() const { return 25.4 * settings_.screen_diagonal_in.value_or(0); }

int Room::meaning_of(int key) const {
  const auto found = settings_.keys.find(key);
  return found == settings_.keys.end() ? key : pedals::key_of(found->second);
}

void Room::press_pedals(widgets::Actions& actions, const std::vector<std::string_view>& prefixes,
                        bool is_typing) {
  if (foot_switch_ == nullptr) return;
  for (const pedals::PedalEvent& event : foot_switch_->take()) {
    const int key = pedals::key_of(event.pedal);
    if (!event.is_down) actions.release(key);
    // A foot writes nothing into a field, and must not be caught in one that was opened by a slip.
    else if (!is_typing || event.pedal == pedals::Pedal::Back)
      actions.press({key, 0, false}, prefixes);
  }
}

void Room::drop_pedals(widgets::Actions& actions, const std::function<void()>& pressed) {
  if (foot_switch_ == nullptr) return;
  for (const pedals::PedalEvent& event : foot_switch_->take()) {
    if (event.is_down)
      pressed();
    else
      actions.release(pedals::key_of(event.pedal));
  }
}

std::string Room::trouble() const {
  if (!settings_trouble_.empty()) return settings_trouble_;
  const std::string trouble = foot_switch_ != nullptr ? foot_switch_->status().trouble : "";
  return trouble.empty() ? "" : "Foot switch " + trouble;
}

std::string Room::devices() const {
  std::string names;
  if (foot_switch_ != nullptr)
    for (const std::string& name : foot_switch_->status().devices)
      names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

}  // namespace arthronaut::window
