// What is held down, in large letters beside a ring that fills, at the lower edge of a screen; and for a
// while what was let go too early.
#pragma once

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

// Over everything; nothing when nothing is held or to be reminded of.
void draw_hold_hint(const Ui& ui, const Rect& window);

}  // namespace arthronaut::widgets
