// The list of every key that works in a mode, over the screen.
#pragma once

#include <string_view>
#include <vector>

#include "app/widgets/controls.h"

namespace arthronaut::window {

// Of the actions whose id starts with one of the prefixes.
void draw_key_list(const widgets::Ui& ui, const std::vector<std::string_view>& prefixes);

}  // namespace arthronaut::window
