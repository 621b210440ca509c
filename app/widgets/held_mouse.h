// The mouse's way while something is held by it.
#pragma once

#include <imgui.h>

namespace arthronaut::widgets {

// Of the item drawn last, which is active: since the frame before, in pixels. What the mouse went before it
// was pressed, in the frame of the press, is none of it: in a slow frame that is a long way.
inline ImVec2 held_mouse_way_px() {
  return ImGui::IsItemActivated() ? ImVec2(0, 0) : ImGui::GetIO().MouseDelta;
}

}  // namespace arthronaut::widgets
