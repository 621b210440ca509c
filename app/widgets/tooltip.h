// What is said of a thing while the mouse rests on it: as wide as can be read, over several lines where it is
// long. It lies beside the thing and over no button, which may be clicked next.
#pragma once

#include <string_view>

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

// Of the item that was laid out last.
void tooltip(const Ui& ui, std::string_view text);
void tooltip(const Ui& ui, const Rect& about, std::string_view text);
// Of what a picture shows under the mouse.
void tooltip_at_mouse(const Ui& ui, std::string_view text);

}  // namespace arthronaut::widgets
