#include <algorithm>
#include <cmath>

#include "app/setup/setup_panels.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::setup {

namespace {

void ring_label(const widgets::Ui& ui, const ImVec2& center, float radius, double value_deg) {
  const std::string text = widgets::fixed(value_deg, 0) + "\u00B0";
  ImFont* font = ui.theme.body;
  const float diagonal = radius * 0.7071F;
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize,
                                      {center.x + diagonal + 2, center.y + diagonal - 2}, widgets::kQuietText,
                                      text.c_str());
}

}  // namespace

void draw_marker(const widgets::Ui& ui, const widgets::PicturePlacement& place,
                 const std::array<Eigen::Vector2d, 4>& corners_px) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  std::array<ImVec2, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto corner = place.on_screen(corners_px[i]);
    if (!corner) return;
    corners[i] = *corner;
  }
  draw.AddPolyline(corners.data(), 4, widgets::kGood, ImDrawFlags_Closed, ui.theme.px(3));
  draw.AddCircleFilled(corners[0], ui.theme.px(6), widgets::kGood);  // top left as printed
}

void draw_cone(const widgets::Ui& ui, const widgets::Rect& area, const tools::PivotCalibrationSummary& tip,
               double wanted_deg) {
  constexpr double kOuter_deg = 46;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 center = area.center();
  const float outer = 0.5F * std::min(area.width, area.height) - ui.theme.px(14);
  if (outer <= 0) return;
  const auto scaled = [&](double deg) { return outer * static_cast<float>(deg / kOuter_deg); };
  draw.AddCircleFilled(center, outer, IM_COL32(14, 17, 21, 255), 96);
  if (tip.cone_deg > 0)  // how far the cone has been filled
    draw.AddCircleFilled(center, scaled(std::min(tip.cone_deg, kOuter_deg)), IM_COL32(64, 200, 150, 34), 96);
  for (const double deg : {10.0, 20.0, 30.0}) {
    const bool is_limit = std::abs(deg - wanted_deg) < 0.5;
    draw.AddCircle(center, scaled(deg), is_limit ? widgets::kText : widgets::kPanelEdge, 96,
                   ui.theme.px(is_limit ? 3.F : 2.F));
    ring_label(ui, center, scaled(deg), deg);
  }
  draw.AddLine({center.x - outer, center.y}, {center.x + outer, center.y}, widgets::kPanelEdge);
  draw.AddLine({center.x, center.y - outer}, {center.x, center.y + outer}, widgets::kPanelEdge);
  const float dot = ui.theme.px(4);
  for (std::size_t i = 0; i < tip.tilt_deg.size(); ++i) {
    Eigen::Vector2d tilt = tip.tilt_deg[i];
    if (tilt.norm() > kOuter_deg) tilt *= kOuter_deg / tilt.norm();  // on the edge, not beyond
    const ImVec2 at{center.x + scaled(tilt.x()), center.y - scaled(tilt.y())};
    const bool is_inlier = i < tip.is_inlier.size() && tip.is_inlier[i];
    if (i + 1 == tip.tilt_deg.size()) {  // the newest
      draw.AddCircle(at, 3 * dot, widgets::kAccent, 24, ui.theme.px(3));
    }
    if (is_inlier)
      draw.AddCircleFilled(at, dot, widgets::kGood, 12);
    else
      draw.AddCircle(at, dot, widgets::kCaution, 12, ui.theme.px(2));  // left out
  }
}

void draw_turn(const widgets::Ui& ui, const widgets::Rect& area, double turned_deg, double wanted_deg) {
  // The angle on the screen of so many degrees of turn; it starts at the top.
  const auto at = [](double deg) { return static_cast<float>(geometry::rad_from_deg(deg - 90)); };
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 center = area.center();
  const float radius = 0.5F * std::min(area.width, area.height) - ui.theme.px(40);
  if (radius <= 0) return;
  const float width = ui.theme.px(26);
  draw.AddCircle(center, radius, IM_COL32(14, 17, 21, 255), 96, width);
  const bool is_enough = turned_deg >= wanted_deg;
  if (turned_deg > 1) {
    draw.PathArcTo(center, radius, at(0), at(std::min(turned_deg, 360.0)), 96);
    draw.PathStroke(is_enough ? widgets::kGood : widgets::kCaution, 0, width);
  }
  const float limit = at(wanted_deg);
  const ImVec2 way{std::cos(limit), std::sin(limit)};
  draw.AddLine({center.x + way.x * (radius - width), center.y + way.y * (radius - width)},
               {center.x + way.x * (radius + width), center.y + way.y * (radius + width)}, widgets::kText,
               ui.theme.px(4));
  const std::string text = widgets::fixed(turned_deg, 0) + "\u00B0";
  const float wide = widgets::number_width(ui.theme.number, text);
  widgets::draw_number(draw, ui.theme.number, {center.x - wide / 2, center.y - ui.theme.number->FontSize / 2},
                       widgets::kText, text);
}

}  // namespace arthronaut::setup
