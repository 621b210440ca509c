#include <algorithm>
#include <cmath>

#include "app/navigate/navigate_panels.h"
#include "app/navigate/overlay_lines.h"
#include "app/widgets/picture_placement.h"

namespace arthronaut::navigate {

namespace {

constexpr ImU32 kBlack = IM_COL32(0, 0, 0, 255);

// Black between picture and edge, and not under the picture: what is covered costs as much.
void fill_around(ImDrawList& draw, const widgets::Rect& area, const widgets::Rect& picture) {
  const ImVec2 a = area.min(), b = area.max(), p = picture.min(), q = picture.max();
  draw.AddRectFilled(a, {b.x, p.y}, kBlack);
  draw.AddRectFilled({a.x, q.y}, b, kBlack);
  draw.AddRectFilled({a.x, p.y}, {p.x, q.y}, kBlack);
  draw.AddRectFilled({q.x, p.y}, {b.x, q.y}, kBlack);
}

// The picture fills as much of the area as its shape allows; returns where its pixels stand.
struct DrawnPicture {
  widgets::Rect area;
  widgets::PicturePlacement placement;
};

DrawnPicture draw_picture(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen,
                          VideoTextures& textures) {
  const widgets::WidgetLog::Timed timed(ui.log, "video_ms");
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const theatre::LiveState& live = *screen.live;
  const ImU32 tint =
      screen.display.is_live ? IM_COL32_WHITE : IM_COL32(120, 120, 120, 255);  // not live: visibly dimmed
  const auto put = [&](const auto& shown, const widgets::Rect& at, const ImVec2& uv_min,
                       const ImVec2& uv_max) {
    widgets::draw_opaque(draw, shown.texture(), shown.version(), at, uv_min, uv_max, tint);
  };
  const widgets::Rect part =
      widgets::shown_part(screen.options().calibration.boundary, live.picture->width, live.picture->height);
  ui.log.add("uploaded_bytes", static_cast<double>(textures.raw.upload(live.picture, part)));
  ui.log.add("picture", static_cast<double>(live.picture->index));
  ui.log.add("captured_s", live.captured_s);
  if (screen.undistorts) {
    // Whole pixels: the texture is drawn one to one.
    widgets::Rect square = widgets::fitted(area, 1);
    square = {std::floor(square.x), std::floor(square.y), std::floor(square.width), std::floor(square.width)};
    const int size_px = std::max(static_cast<int>(square.width), 1);
    textures.undistorted.draw(live.picture, textures.raw, screen.frame().camera, size_px);
    put(textures.undistorted, square, {0, 0}, {1, 1});
    return {square, {square, screen.frame().camera, textures.undistorted.view()}};
  }
  const widgets::Rect picture = widgets::fitted(area, part.width / part.height);
  put(textures.raw, picture, textures.raw.place_of(part.min()), textures.raw.place_of(part.max()));
  return {picture, {picture, part}};
}

}  // namespace

const PictureLines& NavigateScreen::lines() const {
  static const PictureLines kNone;
  const auto* made = live != nullptr ? dynamic_cast<const PictureLines*>(live->decoration.get()) : nullptr;
  return made != nullptr ? *made : kNone;
}

void draw_video(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen,
                VideoTextures& textures) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("navigate.video_panel", area.min(), area.max());
  const NavigateDisplay& display = screen.display;
  if (!display.has_picture) {
    draw.AddRectFilled(area.min(), area.max(), kBlack, ui.theme.px(6));
    const float middle = area.center().y, height = ui.theme.px(60);
    widgets::text_centered(ui, {area.x, middle - height, area.width, height}, ui.theme.afar, widgets::kText,
                           display.headline);
    // Before there is a source what there is to say stands beside the step alone.
    if (screen.live != nullptr && screen.live->phase != theatre::LiveState::Phase::NoSource)
      widgets::text_centered(ui, {area.x, middle, area.width, 3 * height}, ui.theme.title,
                             widgets::kQuietText, display.detail);
    return;
  }
  const DrawnPicture picture = draw_picture(ui, area, screen, textures);
  fill_around(draw, area, picture.area);
  const widgets::WidgetLog::Timed timed(ui.log, "overlay_ms");
  draw.PushClipRect(picture.area.min(), picture.area.max(), true);
  const auto draw_lines = [&](const scene::PlanOverlay& lines) {
    // Strokes have done their work once the guide is aimed: the plan is what counts then.
    const bool aims = screen.layout == NavigateLayout::Guide && display.plan_is_valid;
    draw_overlay_lines(draw, picture.placement, lines,
                       {screen.overlay_opacity, ui.theme.scale, aims ? 0.3F : 1.F});
  };
  if (display.plan_is_valid && screen.overlay_opacity > 0) draw_lines(screen.lines().plan);
  if (display.overlay_is_valid && screen.overlay_opacity > 0) draw_lines(screen.lines().touched);
  draw.PopClipRect();
  if (screen.undistorts)
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize,
                 {area.x + ui.theme.px(14), area.y + ui.theme.px(9)}, widgets::kQuietText, "Undistorted");
  // Numbers without lines beside them ask for a reason.
  if (display.guidance_is_valid) {
    const std::string reason = screen.options().tools.tracker
                                   ? "No plan over the picture: the tracker does not see the arthroscope"
                                   : why_no_plan_line(screen.lines().plan, screen.overlay_opacity);
    ui.log.note_state("no_overlay", reason);
    widgets::Rect below = area;
    (void)below.cut_top(ui.theme.px(screen.undistorts ? 44 : 0));
    if (!reason.empty()) widgets::caption(ui, below, widgets::kCaution, reason);
  }
  // By its edge alone: nothing lies over the picture, and so over no marker.
  const bool is_expected = screen.layout == NavigateLayout::Register && display.world_is_placed;
  if (!display.guidance_is_valid && !is_expected)
    draw.AddRect(area.min(), area.max(), widgets::kCaution, ui.theme.px(6), 0, ui.theme.px(5));
  else if (screen.reached_for_s)
    draw.AddRect(area.min(), area.max(), widgets::kGood, ui.theme.px(6), 0,
                 ui.theme.px(*screen.reached_for_s < 1 ? 14 : 7));
}

}  // namespace arthronaut::navigate
