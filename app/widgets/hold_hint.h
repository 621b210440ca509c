// What is held down, in large letters beside a ring that fills; and for a while what was let go too early.
#pragma once

#include <optional>

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

// Over buttons or steps, never over a picture or a number: at the lower edge of the window, where its bars
// are; where a mode has the whole window, right under the header that it leaves. Nothing when nothing is held
// or to be reminded of.
void draw_hold_hint(const Ui& ui, const Rect& window, const std::optional<Rect>& header);

}  // namespace arthronaut::widgets
