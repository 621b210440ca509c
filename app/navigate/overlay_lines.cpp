#include "app/navigate/overlay_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene/scene_content.h"
#include "app/widgets/theme.h"

namespace arthronaut::navigate {

namespace {

using scene::OverlayLine;

struct LineStyle {
  ImU32 color;
  float width;
};

LineStyle style_of(const OverlayLine& line, float opacity, float scale) {
  const float seen = line.is_hidden ? 0.35F * opacity : opacity;
  switch (line.kind) {
    case OverlayLine::Kind::BoneOutline:
      return {widgets::color_of(scene::Color{1, 1, 1}, 0.5F * seen), 2.0F * scale};
    case OverlayLine::Kind::EntryRing:
      return {widgets::color_of(scene::Color{1, 1, 1}, seen), 3.5F * scale};
    case OverlayLine::Kind::TunnelWall:
      return {widgets::color_of(scene::kPlanColor, 0.75F * seen), 2.0F * scale};
    case OverlayLine::Kind::TunnelAxis:
      return {widgets::color_of(scene::kPlanColor, seen), 3.0F * scale};
    case OverlayLine::Kind::Curve:
      return {widgets::color_of(scene::kCurveColor, 0.9F * seen), 3.0F * scale};
  }
  return {widgets::kText, scale};
}

}  // namespace

float overlay_opacity(double since_shown_s) {
  constexpr double kFull_s = 8, kFading_s = 2;
  constexpr float kFaded = 0.25F;
  const double faded = std::clamp((since_shown_s - kFull_s) / kFading_s, 0.0, 1.0);
  return 1 - static_cast<float>(faded) * (1 - kFaded);
}

void draw_overlay_lines(ImDrawList& draw, const widgets::PicturePlacement& placement,
                        const scene::PlanOverlay& overlay, float opacity, float scale) {
  for (const OverlayLine& line : overlay) {
    const LineStyle style = style_of(line, opacity, scale);
    // A probe at rest trembles about one place: a line through all that is nothing but spikes.
    const float least = line.kind == OverlayLine::Kind::Curve ? 2 * style.width : 0;
    std::optional<ImVec2> last;
    for (const Eigen::Vector2d& p : line.points_px) {
      const auto at = placement.on_screen(p);
      if (!at || (last && std::hypot(at->x - last->x, at->y - last->y) < least)) continue;
      draw.PathLineTo(*at);
      last = at;
    }
    draw.PathStroke(style.color, 0, style.width);
  }
}

std::string why_no_plan_line(const scene::PlanOverlay& overlay, float opacity) {
  if (opacity <= 0) return "Plan on video is off (V)";
  const bool has_one = std::any_of(overlay.begin(), overlay.end(), [](const OverlayLine& line) {
    return line.kind != OverlayLine::Kind::Curve && line.kind != OverlayLine::Kind::BoneOutline;
  });
  return has_one ? "" : "No plan on video: tools lie over it, or it is out of view";
}

}  // namespace arthronaut::navigate
