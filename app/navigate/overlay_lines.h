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

// scale: of the theme. Wider than 3.5 px at scale 1 is no line.
void draw_overlay_lines(ImDrawList& draw, const widgets::PicturePlacement& placement,
                        const scene::PlanOverlay& overlay, float opacity, float scale);

// Why no line of the plan is seen although it is valid: switched off, or tools lie over all of it. Empty when
// one is seen.
[[nodiscard]] std::string why_no_plan_line(const scene::PlanOverlay& overlay, float opacity);

}  // namespace arthronaut::navigate
