#include "app/setup/setup_panels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::setup {

namespace {

using widgets::Severity;

ImVec2 on_circle(const ImVec2& center, float radius, double angle_deg) {
  const double angle = geometry::rad_from_deg(angle_deg);
  return {center.x + radius * static_cast<float>(std::cos(angle)),
          center.y + radius * static_cast<float>(std::sin(angle))};
}

}  // namespace

widgets::PicturePlacement draw_picture(const widgets::Ui& ui, const widgets::Rect& area,
                                       widgets::VideoTexture& texture, const camera::FramePtr& picture,
                                       const camera::Boundary& view, bool is_live) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("setup.picture", area.min(), area.max());
  if (picture == nullptr) return {area, area};
  texture.upload(picture);
  const float w = static_cast<float>(texture.width()), h = static_cast<float>(texture.height());
  const widgets::Rect part = widgets::shown_part(view, texture.width(), texture.height());
  const widgets::Rect screen = widgets::fitted(area, part.width / part.height);
  const ImU32 tint = is_live ? IM_COL32_WHITE : IM_COL32(120, 120, 120, 255);
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.texture())), screen.min(),
                screen.max(), {part.x / w, part.y / h},
                {(part.x + part.width) / w, (part.y + part.height) / h}, tint);
  return {screen, part};
}

void draw_band(const widgets::Ui& ui, const widgets::Rect& area, const Band& band) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), widgets::color_of(band.severity), ui.theme.px(6), 0, ui.theme.px(2));
  const float radius = ui.theme.px(17);
  widgets::draw_sign(draw, {area.x + ui.theme.px(36), area.center().y}, radius, band.severity);
  const float left = area.x + ui.theme.px(72);
  const float wrap = std::max(area.x + area.width - left - ui.theme.px(12), 1.F);
  ImFont* title = ui.theme.title;
  ImFont* body = ui.theme.body;
  const auto size = [&](ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, wrap, text.c_str());
  };
  // A headline that would wrap is set in the smaller type: the band keeps its height.
  ImFont* head = title->CalcTextSizeA(title->FontSize, 1e9F, 0, band.headline.c_str()).x <= wrap
                     ? title
                     : ui.theme.strong;
  const ImVec2 head_size = size(head, band.headline);
  const float height = head_size.y + (band.detail.empty() ? 0 : size(body, band.detail).y);
  float y = area.y + std::max((area.height - height) / 2, ui.theme.px(4));
  draw.PushClipRect(area.min(), area.max(), true);
  draw.AddText(head, head->FontSize, {left, y}, widgets::kText, band.headline.c_str(), nullptr, wrap);
  y += head_size.y;
  draw.AddText(body, body->FontSize, {left, y}, widgets::kQuietText, band.detail.c_str(), nullptr, wrap);
  draw.PopClipRect();
}

void draw_rows(const widgets::Ui& ui, const char* name, const widgets::Rect& area, std::string_view title,
               std::span<const Row> rows) {
  widgets::begin_panel(ui, name, area, title);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(8), ui.theme.px(7)});
  for (const Row& row : rows) widgets::status_row(ui, row.severity, row.name, row.text);
  ImGui::PopStyleVar();
  widgets::end_panel();
}

void draw_lens_dial(const widgets::Ui& ui, const widgets::Rect& area, std::span<const double> taken_deg,
                    double now_deg, double too_near_deg) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 center = area.center();
  const float radius = 0.5F * std::min(area.width, area.height) - ui.theme.px(26);
  if (radius <= 0) return;
  draw.AddCircleFilled(center, radius, IM_COL32(14, 17, 21, 255), 96);
  for (const double angle : taken_deg) {
    draw.PathLineTo(center);
    draw.PathArcTo(center, radius, static_cast<float>(geometry::rad_from_deg(angle - too_near_deg)),
                   static_cast<float>(geometry::rad_from_deg(angle + too_near_deg)), 24);
    draw.PathFillConvex(IM_COL32(64, 76, 90, 110));
  }
  draw.AddCircle(center, radius, widgets::kPanelEdge, 96, ui.theme.px(2));
  ImFont* font = ui.theme.strong;
  for (std::size_t i = 0; i < taken_deg.size(); ++i) {
    draw.AddLine(on_circle(center, 0.55F * radius, taken_deg[i]), on_circle(center, radius, taken_deg[i]),
                 widgets::kGood, ui.theme.px(3));
    const std::string text = std::to_string(i + 1);
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str());
    const ImVec2 at = on_circle(center, radius + ui.theme.px(15), taken_deg[i]);
    draw.AddText(font, font->FontSize, {at.x - size.x / 2, at.y - size.y / 2}, widgets::kGood, text.c_str());
  }
  if (std::isfinite(now_deg)) {
    const ImVec2 tip = on_circle(center, 0.92F * radius, now_deg);
    draw.AddLine(center, tip, widgets::kAccent, ui.theme.px(4));
    draw.AddTriangleFilled(on_circle(center, radius, now_deg), on_circle(center, 0.84F * radius, now_deg - 7),
                           on_circle(center, 0.84F * radius, now_deg + 7), widgets::kAccent);
  }
  draw.AddCircleFilled(center, ui.theme.px(5), widgets::kQuietText);
}

}  // namespace arthronaut::setup
