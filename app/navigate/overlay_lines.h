// The plan's lines as they are put over the picture: thin, faded after a while, and never gone without a
// reason.
#pragma once

#include <imgui.h>

#include <string>

#include "app/scene/plan_overlay.h"
#include "app/widgets/picture_placement.h"

namespace arthronaut::navigate {

// AR can blind: what is drawn over the picture stands out for 8 s after it was shown, then fades within 2 s
// to a hint of a quarter. 0 to 1.
[[nodiscard]] float overlay_opacity(double since_shown_s);

struct OverlayLook {
  float opacity = 1;
  float scale = 1;           // of the theme. Wider than 4 px at scale 1 is no line.
  float stroke_opacity = 1;  // of what was touched, beside the plan's
};
// The tunnel as a body: its wall shaded, its mouth and its outline drawn through where they are seen and
// dashed where the bone hides them.
void draw_overlay_lines(ImDrawList& draw, const widgets::PicturePlacement& placement,
                        const scene::PlanOverlay& overlay, const OverlayLook& look);

// Why no line of the plan is seen although it is valid: switched off, or tools lie over all of it. Empty when
// one is seen.
[[nodiscard]] std::string why_no_plan_line(const scene::PlanOverlay& overlay, float opacity);

}  // namespace arthronaut::navigate
