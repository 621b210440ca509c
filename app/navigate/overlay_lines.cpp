#include "app/navigate/overlay_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/navigate/touched_picture.h"
#include "app/scene/scene_content.h"
#include "app/widgets/theme.h"

namespace arthronaut::navigate {

namespace {

using scene::OverlayLine;

struct LineStyle {
  ImU32 color;
  float width;
};

LineStyle style_of(const OverlayLine& line, const OverlayLook& look) {
  // Behind the bone a line is dashed; that and a little less of it say so.
  const float seen = line.is_hidden ? 0.8F * look.opacity : look.opacity;
  switch (line.kind) {
    case OverlayLine::Kind::BoneOutline:
      return {widgets::color_of(scene::Color{1, 1, 1}, 0.5F * seen), 2.0F * look.scale};
    case OverlayLine::Kind::EntryRing:
      return {widgets::color_of(scene::Color{1, 1, 1}, seen), 4.0F * look.scale};
    case OverlayLine::Kind::TunnelWall:
      return {widgets::color_of(scene::kPlanColor, seen), 3.0F * look.scale};
    case OverlayLine::Kind::TunnelAxis:
      return {widgets::color_of(scene::kPlanColor, seen), 3.0F * look.scale};
    case OverlayLine::Kind::TunnelFace: {
      // Like glass: what is seen edge on is dense, what faces the eye is all but clear. A body that lies in
      // the tunnel's mouth must be seen through it.
      const float edge = 1 - line.shade;
      return {widgets::color_of(scene::kPlanColor, (0.08F + 0.45F * edge * edge * edge) * look.opacity), 0};
    }
    case OverlayLine::Kind::Curve:
      // As what was drawn: whether it lies on the bone is the 3D view's to say, where green means that.
      return {widgets::color_of(kDrawnColor, 0.9F * seen * look.stroke_opacity), 3.0F * look.scale};
  }
  return {widgets::kText, look.scale};
}

void draw_face(ImDrawList& draw, const widgets::PicturePlacement& placement, const OverlayLine& face,
               ImU32 color) {
  std::array<ImVec2, 4> corners;
  if (face.points_px.size() != corners.size()) return;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto at = placement.on_screen(face.points_px[i]);
    if (!at) return;
    corners[i] = *at;
  }
  // Edges that are smoothed would show as seams between neighbours.
  const ImDrawListFlags flags = std::exchange(draw.Flags, draw.Flags & ~ImDrawListFlags_AntiAliasedFill);
  draw.AddQuadFilled(corners[0], corners[1], corners[2], corners[3], color);
  draw.Flags = flags;
}

// Dashes run on from point to point: how far into a dash or a gap the line is, is kept between them.
class DashedLine {
 public:
  DashedLine(ImDrawList& draw, const LineStyle& style, float scale)
      : draw_(draw), style_(style), dash_(9 * scale), gap_(7 * scale) {}
  void to(const ImVec2& at) {
    const ImVec2 from = std::exchange(last_, at);
    if (!std::exchange(has_last_, true)) return;
    const float dx = at.x - from.x, dy = at.y - from.y, length = std::hypot(dx, dy);
    for (float done = 0; done < length;) {
      const bool is_dash = phase_ < dash_;
      const float step = std::min((is_dash ? dash_ : dash_ + gap_) - phase_, length - done);
      const auto point = [&](float along) {
        return ImVec2{from.x + dx * along / length, from.y + dy * along / length};
      };
      if (is_dash) draw_.AddLine(point(done), point(done + step), style_.color, style_.width);
      done += step;
      phase_ += step;
      if (phase_ >= dash_ + gap_ - 1e-3F) phase_ = 0;
    }
  }

 private:
  ImDrawList& draw_;
  LineStyle style_;
  float dash_, gap_, phase_ = 0;
  ImVec2 last_{0, 0};
  bool has_last_ = false;
};

}  // namespace

float overlay_opacity(double since_shown_s) {
  constexpr double kFull_s = 8, kFading_s = 2;
  constexpr float kFaded = 0.25F;
  const double faded = std::clamp((since_shown_s - kFull_s) / kFading_s, 0.0, 1.0);
  return 1 - static_cast<float>(faded) * (1 - kFaded);
}

void draw_overlay_lines(ImDrawList& draw, const widgets::PicturePlacement& placement,
                        const scene::PlanOverlay& overlay, const OverlayLook& look) {
  for (const OverlayLine& line : overlay) {
    const LineStyle style = style_of(line, look);
    if (line.kind == OverlayLine::Kind::TunnelFace) {
      draw_face(draw, placement, line, style.color);
      continue;
    }
    // A probe at rest trembles about one place: a line through all that is nothing but spikes.
    const float least = line.kind == OverlayLine::Kind::Curve ? 2 * style.width : 0;
    DashedLine dashes(draw, style, look.scale);
    std::optional<ImVec2> last;
    for (const Eigen::Vector2d& p : line.points_px) {
      const auto at = placement.on_screen(p);
      if (!at || (last && std::hypot(at->x - last->x, at->y - last->y) < least)) continue;
      if (line.is_hidden)
        dashes.to(*at);
      else
        draw.PathLineTo(*at);
      last = at;
    }
    if (!line.is_hidden) draw.PathStroke(style.color, 0, style.width);
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
