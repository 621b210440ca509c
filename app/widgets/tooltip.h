// What is said of a thing while the mouse rests on it: as wide as can be read, over several lines where it is
// long.
#pragma once

#include <string_view>

#include "app/widgets/theme.h"

namespace arthronaut::widgets {

void tooltip(const Theme& theme, std::string_view text);

}  // namespace arthronaut::widgets
