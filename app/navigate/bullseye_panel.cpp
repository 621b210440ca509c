#include <algorithm>
#include <array>
#include <cmath>

#include "app/guidance_severity/guidance_severity.h"
#include "app/navigate/navigate_panels.h"

namespace arthronaut::navigate {

namespace {

constexpr double kShown_mm = 6;  // radius of the whole bullseye
constexpr std::array<double, 3> kRings_mm{1, 2, 5};

void draw_target(const widgets::Ui& ui, ImDrawList& draw, const ImVec2& center, float radius) {
  const float per_mm = radius / static_cast<float>(kShown_mm);
  draw.AddCircleFilled(center, radius, IM_COL32(15, 19, 24, 255), 96);
  for (const double ring : kRings_mm) {
    const float r = static_cast<float>(ring) * per_mm;
    draw.AddCircle(center, r, ring == 1 ? widgets::kGood : IM_COL32(90, 104, 118, 255), 96,
                   ui.theme.px(ring == 1 ? 3 : 2));
    const std::string text = widgets::fixed(ring, 0) + (ring == 5 ? " mm" : "");
    draw.AddText(ui.theme.body, ui.theme.body->FontSize,
                 {center.x + r * 0.72F + ui.theme.px(3), center.y + r * 0.70F}, widgets::kQuietText,
                 text.c_str());
  }
  draw.AddLine({center.x - radius, center.y}, {center.x + radius, center.y}, IM_COL32(64, 75, 86, 255),
               ui.theme.px(1.5F));
  draw.AddLine({center.x, center.y - radius}, {center.x, center.y + radius}, IM_COL32(64, 75, 86, 255),
               ui.theme.px(1.5F));
}

void draw_directions(const widgets::Ui& ui, ImDrawList& draw, const widgets::Rect& area, const ImVec2& center,
                     float radius, const BullseyePoint& point) {
  ImFont* font = ui.theme.strong;
  const auto put = [&](landmarks::AnatomicalDirection direction, bool is_positive, float x, float y,
                       float align) {
    const std::string text(landmarks::to_text(direction, is_positive));
    const float width = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
    const float left = std::clamp(x - width * align, area.x + 4, area.x + area.width - width - 4);
    draw.AddText(font, font->FontSize, {left, y}, widgets::kQuietText, text.c_str());
  };
  put(point.up_is, true, center.x, center.y - radius - font->FontSize * 1.15F, 0.5F);
  put(point.up_is, false, center.x, center.y + radius + font->FontSize * 0.1F, 0.5F);
  const float y = center.y - font->FontSize * 1.2F;
  const float gap = ui.theme.px(6);
  put(point.side_is, point.side_is_right, center.x + radius + gap, y, 0);
  put(point.side_is, !point.side_is_right, center.x - radius - gap, y, 1);
}

// The axis of the guide as a dot with a tail that leans as the guide does: 1 degree as long as 1 mm.
void draw_guide(const widgets::Ui& ui, ImDrawList& draw, const ImVec2& center, float radius,
                const BullseyePoint& point, widgets::Severity severity) {
  const float per_mm = radius / static_cast<float>(kShown_mm);
  ImVec2 at{center.x + static_cast<float>(point.right_mm) * per_mm,
            center.y - static_cast<float>(point.up_mm) * per_mm};
  const float dx = at.x - center.x, dy = at.y - center.y, far = std::hypot(dx, dy);
  const bool is_outside = far > radius;
  if (is_outside) at = {center.x + dx / far * radius, center.y + dy / far * radius};
  const ImU32 color = widgets::color_of(severity);
  if (is_outside) {  // an arrow head on the rim says: farther that way
    const ImVec2 out{dx / far, dy / far};
    const float size = ui.theme.px(20);
    draw.AddTriangleFilled({at.x + out.x * size, at.y + out.y * size},
                           {at.x - out.y * size * 0.7F, at.y + out.x * size * 0.7F},
                           {at.x + out.y * size * 0.7F, at.y - out.x * size * 0.7F}, color);
    return;
  }
  // A lean that would leave the bullseye ends at its rim.
  const float lean = static_cast<float>(std::hypot(point.lean_right_deg, point.lean_up_deg)) * per_mm;
  const float shown =
      lean > 0 ? std::min(1.F, std::max(radius - std::hypot(at.x - center.x, at.y - center.y), 0.F) / lean)
               : 0;
  const ImVec2 tail{at.x + static_cast<float>(point.lean_right_deg) * per_mm * shown,
                    at.y - static_cast<float>(point.lean_up_deg) * per_mm * shown};
  draw.AddLine(at, tail, color, ui.theme.px(5));
  draw.AddCircle(at, ui.theme.px(15), color, 32, ui.theme.px(4));
  widgets::draw_sign(draw, at, ui.theme.px(9), severity);
}

widgets::Severity worse(widgets::Severity a, widgets::Severity b) {
  const auto rank = [](widgets::Severity s) {
    return s == widgets::Severity::Bad ? 2 : s == widgets::Severity::Caution ? 1 : 0;
  };
  return rank(a) >= rank(b) ? a : b;
}

}  // namespace

void draw_bullseye(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  ui.log.note("navigate.bullseye", area.min(), area.max());
  const float font = ui.theme.strong->FontSize;
  const float radius = std::max(std::min(area.width / 2 - font * 3.4F, area.height / 2 - font * 1.6F), 10.F);
  const ImVec2 center = area.center();
  // Which of two is aimed at stands beside the target, also while there is nothing to aim by.
  draw.AddText(ui.theme.title, ui.theme.title->FontSize, {area.x + ui.theme.px(16), area.y + ui.theme.px(10)},
               widgets::kAccent, screen.tunnel.c_str());
  if (!screen.display.guidance_is_valid || !screen.plan) {
    draw.AddCircle(center, radius, widgets::kPanelEdge, 96, ui.theme.px(2));
    widgets::text_centered(ui, area.inset(font), ui.theme.title, widgets::kCaution, screen.display.headline);
    return;
  }
  const BullseyePoint point = bullseye_point(screen.display.guidance, *screen.plan);
  draw_target(ui, draw, center, radius);
  draw_directions(ui, draw, area, center, radius, point);
  draw_guide(ui, draw, center, radius, point,
             worse(guidance_severity::severity_of_offset(screen.display.guidance),
                   guidance_severity::severity_of_angle(screen.display.guidance)));
}

void draw_numbers(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  ui.log.note("navigate.numbers", area.min(), area.max());
  widgets::Rect rest = area.inset(ui.theme.px(18));
  const bool valid = screen.display.guidance_is_valid;
  const guidance::GuidanceNumbers& g = screen.display.guidance;
  // `mark` stands with the number ("\u00B0"), `unit` after it.
  const auto block = [&](const char* name, double value, const char* mark, const std::string& unit,
                         widgets::Severity severity) {
    const widgets::Rect row = rest.cut_top(rest.height > 0 ? (area.height - ui.theme.px(36)) / 4 : 0);
    // No number at all where none is valid: an old one would be believed.
    widgets::number_block(ui, row, name, valid ? widgets::fixed(value, 1) + mark : "\u2013",
                          valid ? unit : "", valid ? severity : widgets::Severity::Quiet);
    return row;
  };
  const widgets::Rect offset =
      block("Offset", guidance_severity::offset_mm(g), "", "mm " + widgets::plus_minus(g.sigma_offset_mm),
            guidance_severity::severity_of_offset(g));
  if (valid) {
    const guidance_severity::OffsetParts parts = guidance_severity::offset_parts(g);
    const std::string text = parts.side + "\n" + parts.up;
    ImFont* font = ui.theme.body;
    const float width = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
    draw.AddText(font, font->FontSize, {offset.x + offset.width - width, offset.y}, widgets::kText,
                 text.c_str());
  }
  block("Angle", g.angle_deg, "\u00B0", widgets::plus_minus(g.sigma_angle_deg),
        guidance_severity::severity_of_angle(g));
  // Said of a drill that is seen alone: a guide does not know how deep the drill is that runs through it.
  if (valid && g.drill && g.drill->is_at_plan()) {
    block("Drill depth", g.drill->depth_mm, "", "mm " + widgets::plus_minus(g.drill->sigma_mm),
          widgets::Severity::Quiet);
    block("Remaining", g.drill->remaining_mm, "", "mm", guidance_severity::severity_of_drill(*g.drill));
  } else if (const auto& stop_mm = screen.live->operation->depth_stop_mm) {
    // The surgeon's reading, not a measurement: nothing is reckoned from it, least of all what remains.
    const widgets::Rect row = rest.cut_top((area.height - ui.theme.px(36)) / 4);
    widgets::number_block(ui, row, "Depth stop", widgets::fixed(*stop_mm, 1), "mm, as read",
                          widgets::Severity::Quiet);
  }
}

}  // namespace arthronaut::navigate
