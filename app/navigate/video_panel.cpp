#include <algorithm>
#include <cmath>
#include <optional>

#include "app/navigate/navigate_panels.h"
#include "app/widgets/picture_placement.h"

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

void draw_overlay(ImDrawList& draw, const widgets::PicturePlacement& placement,
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

// The picture fills as much of the area as its shape allows; returns where its pixels stand.
struct DrawnPicture {
  widgets::Rect area;
  widgets::PicturePlacement placement;
};

DrawnPicture draw_picture(const widgets::Rect& area, const NavigateScreen& screen, VideoTextures& textures) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const LiveFrame& live = *screen.status->live;
  const ImU32 tint =
      screen.display.is_live ? IM_COL32_WHITE : IM_COL32(120, 120, 120, 255);  // not live: visibly dimmed
  const auto put = [&](std::uint32_t texture, const widgets::Rect& at, const ImVec2& uv_min,
                       const ImVec2& uv_max) {
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)), at.min(), at.max(),
                  uv_min, uv_max, tint);
  };
  textures.raw.upload(live.picture);
  if (screen.undistorts) {
    // Whole pixels: the texture is drawn one to one.
    widgets::Rect square = widgets::fitted(area, 1);
    square = {std::floor(square.x), std::floor(square.y), std::floor(square.width), std::floor(square.width)};
    const int size_px = std::max(static_cast<int>(square.width), 1);
    textures.undistorted.draw(live.picture, textures.raw, live.result.camera, size_px);
    put(textures.undistorted.texture(), square, {0, 0}, {1, 1});
    return {square, {square, live.result.camera, textures.undistorted.view()}};
  }
  const float w = static_cast<float>(textures.raw.width()), h = static_cast<float>(textures.raw.height());
  const widgets::Rect part =
      widgets::shown_part(screen.options->calibration.boundary, textures.raw.width(), textures.raw.height());
  const widgets::Rect picture = widgets::fitted(area, part.width / part.height);
  put(textures.raw.texture(), picture, {part.x / w, part.y / h},
      {(part.x + part.width) / w, (part.y + part.height) / h});
  return {picture, {picture, part}};
}

void draw_reason(const widgets::Ui& ui, const widgets::Rect& area, const NavigateDisplay& display) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float height = ui.theme.px(120);
  const widgets::Rect band{area.x, area.y + area.height - height, area.width, height};
  draw.AddRectFilled(band.min(), band.max(), IM_COL32(10, 12, 15, 225));
  const widgets::Rect head{band.x, band.y + ui.theme.px(12), band.width, ui.theme.px(44)};
  widgets::text_centered(ui, head, ui.theme.title, widgets::kCaution, display.headline);
  widgets::text_centered(ui, {band.x, head.y + head.height, band.width, ui.theme.px(52)}, ui.theme.strong,
                         widgets::kText, display.detail);
}

}  // namespace

void draw_video(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen,
                VideoTextures& textures) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("navigate.video_panel", area.min(), area.max());
  const NavigateDisplay& display = screen.display;
  if (!display.has_picture) {
    const float middle = area.center().y, height = ui.theme.px(60);
    widgets::text_centered(ui, {area.x, middle - height, area.width, height}, ui.theme.title, widgets::kText,
                           display.headline);
    widgets::text_centered(ui, {area.x, middle, area.width, 2 * height}, ui.theme.strong, widgets::kQuietText,
                           display.detail);
    return;
  }
  const DrawnPicture picture = draw_picture(area, screen, textures);
  draw.PushClipRect(picture.area.min(), picture.area.max(), true);
  if (display.overlay_is_valid && screen.overlay_opacity > 0)
    draw_overlay(draw, picture.placement, screen.status->live->overlay, screen.overlay_opacity,
                 ui.theme.scale);
  draw.PopClipRect();
  if (screen.undistorts)
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize,
                 {area.x + ui.theme.px(14), area.y + ui.theme.px(9)}, widgets::kQuietText, "Undistorted");
  // While the bone is registered nothing guides, as it should be: the picture is needed whole.
  const bool is_expected = screen.layout == NavigateLayout::Register && display.overlay_is_valid;
  if (!display.guidance_is_valid && !is_expected) draw_reason(ui, area, display);
}

}  // namespace arthronaut::navigate
