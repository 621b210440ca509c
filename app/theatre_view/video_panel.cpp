#include <algorithm>
#include <cmath>

#include "app/theatre_view/theatre_panels.h"

namespace arthronaut::theatre_view {

namespace {

using scene::OverlayLine;

// The part of the picture that is shown: the square about the round view, inside the image.
struct Crop {
  float x = 0, y = 0, width = 1, height = 1;
};

Crop crop_of(const TheatreScreen& screen, int width, int height) {
  const camera::Calibration& calibration = screen.options->calibration;
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  if (calibration.boundary.radius_px <= 0) return {0, 0, w, h};
  constexpr double kMargin = 1.03;  // the rim moves a little as the lens turns
  const float half = static_cast<float>(kMargin * calibration.boundary.radius_px);
  const float cx = static_cast<float>(calibration.boundary.center_px.x()),
              cy = static_cast<float>(calibration.boundary.center_px.y());
  const float x0 = std::max(cx - half, 0.F), x1 = std::min(cx + half, w);
  const float y0 = std::max(cy - half, 0.F), y1 = std::min(cy + half, h);
  return {x0, y0, std::max(x1 - x0, 1.F), std::max(y1 - y0, 1.F)};
}

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

void draw_overlay(ImDrawList& draw, const widgets::Rect& picture, const Crop& crop,
                  const scene::PlanOverlay& overlay, float opacity, float scale) {
  const float zoom = picture.width / crop.width;
  std::vector<ImVec2> points;
  for (const OverlayLine& line : overlay) {
    points.clear();
    // A pixel's middle is half a pixel inside its edge.
    for (const Eigen::Vector2d& p : line.points_px)
      points.push_back({picture.x + (static_cast<float>(p.x()) + 0.5F - crop.x) * zoom,
                        picture.y + (static_cast<float>(p.y()) + 0.5F - crop.y) * zoom});
    const LineStyle style = style_of(line, opacity, scale);
    draw.AddPolyline(points.data(), static_cast<int>(points.size()), style.color, 0, style.width);
  }
}

void draw_reason(const widgets::Ui& ui, const widgets::Rect& area, const TheatreDisplay& display) {
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

void draw_video(const widgets::Ui& ui, const widgets::Rect& area, const TheatreScreen& screen,
                widgets::VideoTexture& texture) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("operate.video_panel", area.min(), area.max());
  const TheatreDisplay& display = screen.display;
  if (!display.has_picture) {
    const float middle = area.center().y, height = ui.theme.px(60);
    widgets::text_centered(ui, {area.x, middle - height, area.width, height}, ui.theme.title, widgets::kText,
                           display.headline);
    widgets::text_centered(ui, {area.x, middle, area.width, 2 * height}, ui.theme.strong, widgets::kQuietText,
                           display.detail);
    return;
  }
  texture.upload(screen.status->live->picture);
  const Crop crop = crop_of(screen, texture.width(), texture.height());
  const widgets::Rect picture = widgets::fitted(area, crop.width / crop.height);
  const float w = static_cast<float>(texture.width()), h = static_cast<float>(texture.height());
  const ImU32 tint =
      display.is_live ? IM_COL32_WHITE : IM_COL32(120, 120, 120, 255);  // not live: visibly dimmed
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.texture())), picture.min(),
                picture.max(), {crop.x / w, crop.y / h},
                {(crop.x + crop.width) / w, (crop.y + crop.height) / h}, tint);
  draw.PushClipRect(picture.min(), picture.max(), true);
  if (display.overlay_is_valid && screen.overlay_opacity > 0)
    draw_overlay(draw, picture, crop, screen.status->live->overlay, screen.overlay_opacity, ui.theme.scale);
  draw.PopClipRect();
  if (!display.guidance_is_valid) draw_reason(ui, area, display);
}

}  // namespace arthronaut::theatre_view
