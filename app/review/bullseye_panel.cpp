#include <algorithm>
#include <array>
#include <cmath>

#include "app/guidance_severity/guidance_severity.h"
#include "app/review/review_panels.h"
#include "navigation/guidance/bullseye.h"

namespace arthronaut::review {

namespace {

constexpr double kShown_mm = 6;  // radius of the whole bullseye, as in Navigate
constexpr std::array<double, 3> kRings_mm{1, 2, 5};

}  // namespace

void draw_bullseye(const widgets::Ui& ui, const widgets::Rect& area, const ReviewScreen& screen,
                   const landmarks::AnatomicalAxes& axes) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("review.bullseye", area.min(), area.max());
  ImFont* const font = ui.theme.body;
  const float radius =
      std::max(std::min(area.width / 2 - ui.theme.px(70), area.height / 2 - font->FontSize * 1.3F), 10.F);
  const ImVec2 center = area.center();
  const guidance::GuidanceNumbers& numbers = screen.frame().guidance;
  const auto& plan = screen.standing().plan.plan;
  if (!numbers.is_valid() || !plan) {
    draw.AddCircle(center, radius, widgets::kPanelEdge, 96, ui.theme.px(2));
    return widgets::text_centered(ui, area.inset(font->FontSize), ui.theme.strong, widgets::kQuietText,
                                  screen.no_guidance_words());
  }
  const float per_mm = radius / static_cast<float>(kShown_mm);
  draw.AddCircleFilled(center, radius, IM_COL32(15, 19, 24, 255), 96);
  for (const double ring : kRings_mm)
    draw.AddCircle(center, static_cast<float>(ring) * per_mm,
                   ring == 1 ? widgets::kGood : IM_COL32(90, 104, 118, 255), 96, ui.theme.px(2));
  const landmarks::PlaneAxes across = landmarks::axes_across(axes, plan->direction.normalized());
  guidance::BullseyePoint at =
      guidance::bullseye_point(numbers.guide_point_mm, numbers.guide_direction, across, *plan);
  const auto put = [&](float x, float y, float align, std::string_view words) {
    const std::string text(words);
    const float width = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
    draw.AddText(font, font->FontSize, {x - width * align, y}, widgets::kQuietText, text.c_str());
  };
  const float line = font->FontSize, middle = center.y - line / 2, gap = ui.theme.px(6);
  put(center.x, center.y - radius - line * 1.1F, 0.5F, landmarks::to_text(at.up_is, true));
  put(center.x, center.y + radius + line * 0.1F, 0.5F, landmarks::to_text(at.up_is, false));
  put(center.x + radius + gap, middle, 0, landmarks::to_text(at.side_is, at.side_is_right));
  put(center.x - radius - gap, middle, 1, landmarks::to_text(at.side_is, !at.side_is_right));
  // Where the ring crosses the line downwards; the innermost has no room.
  for (const double ring : {2.0, 5.0})
    put(center.x + gap / 2, center.y + static_cast<float>(ring) * per_mm - line * 1.05F, 0,
        widgets::fixed(ring, 0) + (ring == kRings_mm.back() ? " mm" : ""));

  const double far = std::hypot(at.right_mm, at.up_mm);
  const widgets::Severity severity = guidance_severity::severity_of_offset(numbers);
  if (far > kShown_mm) {  // on the rim: farther that way
    at.right_mm *= kShown_mm / far;
    at.up_mm *= kShown_mm / far;
  }
  const ImVec2 dot{center.x + static_cast<float>(at.right_mm) * per_mm,
                   center.y - static_cast<float>(at.up_mm) * per_mm};
  draw.AddLine(center, dot, IM_COL32(90, 104, 118, 255), ui.theme.px(1.5F));
  widgets::draw_sign(draw, dot, ui.theme.px(10), severity);
}

}  // namespace arthronaut::review
