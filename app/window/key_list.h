// The list of every key that works in a mode, over the screen.
#pragma once

#include <string_view>

#include "app/widgets/controls.h"

namespace arthronaut::window {

// mode: "plan", "navigate" or "review".
void draw_key_list(const widgets::Ui& ui, std::string_view mode);

}  // namespace arthronaut::window
