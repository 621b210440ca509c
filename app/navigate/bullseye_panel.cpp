#include <algorithm>
#include <cmath>

#include "app/guidance_severity/guidance_severity.h"
#include "app/navigate/bullseye_rings.h"
#include "app/navigate/navigate_panels.h"
#include "app/widgets/afar_text.h"
#include "navigation/guidance/bullseye.h"

namespace arthronaut::navigate {

namespace {

using guidance::BullseyePoint;

void draw_target(const widgets::Ui& ui, ImDrawList& draw, const ImVec2& center, float radius,
                 ImU32 background) {
  const float per_mm = radius / static_cast<float>(kShown_mm);
  draw.AddCircleFilled(center, radius, background, 96);
  for (const double ring : kRings_mm)
    draw.AddCircle(center, static_cast<float>(ring) * per_mm,
                   ring == 1 ? widgets::kGood : IM_COL32(90, 104, 118, 255), 96,
                   ui.theme.px(ring == 1 ? 3 : 2));
  draw.AddLine({center.x - radius, center.y}, {center.x + radius, center.y}, IM_COL32(64, 75, 86, 255),
               ui.theme.px(1.5F));
  draw.AddLine({center.x, center.y - radius}, {center.x, center.y + radius}, IM_COL32(64, 75, 86, 255),
               ui.theme.px(1.5F));
  ImFont* const font = ui.theme.body;
  const auto width_of = [&](const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
  };
  for (const RingLabel& label : ring_labels(radius, font->FontSize, ui.theme.px(4), width_of))
    draw.AddText(font, font->FontSize, {center.x + label.place.x, center.y + label.place.y},
                 widgets::kQuietText, label.text.c_str());
}

// As large as the panel lets it be.
float target_radius(const widgets::Ui& ui, const widgets::Rect& area) {
  return std::max(std::min(area.width, area.height) / 2 - ui.theme.px(4), 10.F);
}

// In letters for afar, or in small ones where these leave nothing of the target.
void draw_directions(const widgets::Ui& ui, ImDrawList& draw, const widgets::Rect& area, float radius,
                     const BullseyePoint& point, ImU32 color) {
  const ImVec2 center = area.center();
  const DirectionNames names{landmarks::to_text(point.up_is, true), landmarks::to_text(point.up_is, false),
                             landmarks::to_text(point.side_is, !point.side_is_right),
                             landmarks::to_text(point.side_is, point.side_is_right)};
  for (ImFont* const font : {ui.theme.afar, ui.theme.body}) {
    const auto width_of = [&](const std::string& text) {
      return font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
    };
    const TargetWords words = words_in_target(radius, area.width / 2, names, font->FontSize, width_of);
    if (!words.fits) continue;
    for (const DirectionLabel* const label : {&words.up, &words.down, &words.left, &words.right})
      draw.AddText(font, font->FontSize, {center.x + label->place.x, center.y + label->place.y}, color,
                   label->text.c_str());
    ui.log.note_state("directions", font == ui.theme.afar ? "for afar" : "small");
    return;
  }
  ui.log.note_state("directions", "no room");
}

// The axis of the guide as a dot with a tail that leans as the guide does: 1 degree as long as 1 mm.
void draw_guide(const widgets::Ui& ui, ImDrawList& draw, const widgets::Rect& area, float radius,
                const BullseyePoint& point, widgets::Severity severity) {
  const ImVec2 center = area.center();
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
  const ImVec2 lean{static_cast<float>(point.lean_right_deg) * per_mm,
                    -static_cast<float>(point.lean_up_deg) * per_mm};
  const ImVec2 end = tail_end({dx, dy}, lean, {area.width / 2, area.height / 2});
  draw.AddLine(at, {center.x + end.x, center.y + end.y}, color, ui.theme.px(5));
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
  const float font = ui.theme.afar->FontSize;
  const ImVec2 center = area.center();
  // Which of two is aimed at stands beside the target, also while there is nothing to aim by, and over its
  // rim where that comes so near.
  const auto put_name = [&] {
    if (screen.tunnel.empty()) return;
    const ImVec2 at{area.x + ui.theme.px(12), area.y + ui.theme.px(6)};
    const ImVec2 size =
        ui.theme.title->CalcTextSizeA(ui.theme.title->FontSize, 1e9F, 0, screen.tunnel.c_str());
    draw.AddRectFilled(at, {at.x + size.x + ui.theme.px(4), at.y + size.y}, widgets::kPanel);
    draw.AddText(ui.theme.title, ui.theme.title->FontSize, at, widgets::kAccent, screen.tunnel.c_str());
  };
  if (!screen.display.guidance_is_valid || !screen.plan) {
    draw.AddCircle(center, target_radius(ui, area), widgets::kPanelEdge, 96, ui.theme.px(2));
    put_name();
    // That there is no picture is said where it would be.
    if (screen.display.has_picture)
      widgets::text_centered(ui, area.inset(font), ui.theme.title, widgets::kCaution,
                             screen.display.headline);
    return;
  }
  const guidance::GuidanceNumbers& numbers = screen.display.guidance;
  const BullseyePoint point = guidance::bullseye_point(numbers.guide_point_mm, numbers.guide_direction,
                                                       numbers.across_plan, *screen.plan);
  const float radius = target_radius(ui, area);
  // The guide stands on the plan: seen at a glance, by a ring and a tick, in the first second the whole disc.
  const bool is_just_reached = screen.reached_for_s && *screen.reached_for_s < 1;
  draw_target(ui, draw, center, radius,
              is_just_reached ? IM_COL32(40, 120, 92, 255) : IM_COL32(15, 19, 24, 255));
  put_name();
  if (screen.reached_for_s) {
    draw.AddCircle(center, radius - ui.theme.px(6), widgets::kGood, 96, ui.theme.px(12));
    widgets::draw_sign(draw, {area.x + area.width - font * 0.6F, area.y + font * 0.6F}, font * 0.45F,
                       widgets::Severity::Good);
  }
  ui.log.note_state("reached", screen.reached_for_s ? "yes" : "no");
  draw_directions(ui, draw, area, radius, point,
                  screen.reached_for_s ? widgets::kText : widgets::kQuietText);  // on green, too
  draw_guide(ui, draw, area, radius, point,
             worse(guidance_severity::severity_of(screen.display.grades.offset),
                   guidance_severity::severity_of(screen.display.grades.angle)));
}

namespace {

// "Offset", under it "1.2" with "mm ± 0.3" beside it, and lines of words; all of it for afar. `of` stands
// behind the name, in the letters that fit. Returns false, and draws nothing, where there is no room.
bool draw_number(const widgets::Ui& ui, widgets::Rect& rest, const std::string& name,
                 const std::string& value, const std::string& unit, widgets::Severity severity,
                 const std::string& of = "") {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* const font = ui.theme.afar;
  const float height = font->FontSize + ui.theme.number->FontSize;
  if (rest.height < height) return false;
  const widgets::Rect row = rest.cut_top(height);
  const ImU32 color = severity == widgets::Severity::Quiet ? widgets::kText : widgets::color_of(severity);
  float x = row.x;
  if (severity != widgets::Severity::Quiet) {
    const float radius = font->FontSize * 0.36F;
    widgets::draw_sign(draw, {x + radius, row.y + font->FontSize / 2}, radius, severity);
    x += 2.6F * radius;
  }
  draw.AddText(font, font->FontSize, {x, row.y}, widgets::kQuietText, name.c_str());
  if (!of.empty()) {
    x += font->CalcTextSizeA(font->FontSize, 1e9F, 0, (name + " ").c_str()).x;
    const ImVec4 clip{x, row.y, row.x + row.width, row.y + row.height};
    ImFont* const small = widgets::font_that_fits(ui.theme, clip.z - x, font->FontSize, of);
    draw.AddText(small, small->FontSize, {x, row.y + (font->FontSize - small->FontSize) * 0.8F},
                 widgets::kQuietText, of.c_str(), nullptr, 0, &clip);
  }
  const float top = row.y + font->FontSize * 0.95F;
  const float width = widgets::draw_number(draw, ui.theme.number, {row.x, top}, color, value);
  const float right = row.x + width + ui.theme.px(10);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, unit.c_str());
  ImFont* const fits = right + size.x <= row.x + row.width ? font : ui.theme.title;
  draw.AddText(fits, fits->FontSize, {right, top + ui.theme.number->FontSize * 0.9F - fits->FontSize * 0.95F},
               widgets::kQuietText, unit.c_str());
  return true;
}

// Whether a drill has a marker of its own here.
bool has_drill(const NavigateScreen& screen) {
  const std::vector<tools::Tool>& tools = screen.options().tools.tools;
  return std::any_of(tools.begin(), tools.end(),
                     [](const tools::Tool& tool) { return tool.kind == tools::ToolKind::Drill; });
}

// Where it leaves the bone is a danger wherever the plan is.
bool warns_beside(const guidance::DrillDepth& drill) {
  return drill.is_beside_plan() && guidance_severity::severity_of_drill(drill) != widgets::Severity::Quiet;
}

// Which of several drills is seen; empty: there is one, or none is seen.
std::string drill_name(const NavigateScreen& screen) {
  const auto& drill = screen.display.drill;
  return drill ? guidance_severity::drill_name(screen.options().tools, *drill) : "";
}

// For tests.
std::string drill_state(const NavigateScreen& screen) {
  const auto& drill = screen.display.drill;
  if (!drill) return has_drill(screen) ? "not seen" : "none";
  const std::string which = drill_name(screen);
  const std::string name = which.empty() ? "" : which + ": ",
                    text = guidance_severity::drill_text(*drill).name;
  if (drill->is_at_plan()) return name + text;
  return name + (warns_beside(*drill) ? "beside the plan, " + text : "beside the plan");
}

// Nobody has touched a known place by the registration that these numbers are of: said under them, where what
// is said of a drill leaves the room; the sign beside "Bone" says it everywhere.
void draw_unverified(const widgets::Ui& ui, widgets::Rect& rest, const NavigateScreen& screen) {
  constexpr const char* kWords = "Not verified";
  const bool is_skipped = screen.display.is_unverified;
  const float height = widgets::afar_height(ui, rest.width, kWords);
  const float line = ui.theme.afar->FontSize, number = line + ui.theme.number->FontSize;
  const auto& drill = screen.display.drill;
  const bool is_deep = drill && drill->is_at_plan(),
             has_stop = screen.live->operation->depth_stop_mm.has_value();
  const float depth = is_deep ? 2 * number + (drill_name(screen).empty() ? 0 : line)
                              : (drill || has_drill(screen) ? line : 0) +
                                    (drill && warns_beside(*drill) ? number : 0) + (has_stop ? number : 0);
  const bool is_said = is_skipped && rest.height >= height + depth;
  ui.log.note_state("unverified", is_said ? "said" : is_skipped ? "no room" : "no");
  if (is_said) widgets::draw_afar(ui, rest.cut_bottom(height), widgets::kCaution, kWords);
}

}  // namespace

void draw_numbers(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  ui.log.note("navigate.numbers", area.min(), area.max());
  // No number at all where none is valid: an old one would be believed.
  if (!screen.display.guidance_is_valid) return;
  // Close above and below: where a drill is seen every line is needed.
  const float side = ui.theme.px(14), above = ui.theme.px(8);
  widgets::Rect rest{area.x + side, area.y + above, area.width - 2 * side, area.height - 2 * above};
  const guidance::GuidanceNumbers& g = screen.display.guidance;
  draw_number(ui, rest, "Offset", widgets::fixed(g.offset_mm, 1),
              "mm " + widgets::plus_minus(g.sigma_offset_mm),
              guidance_severity::severity_of(screen.display.grades.offset), "of the axis");
  const guidance_severity::OffsetParts parts = guidance_severity::offset_parts(g);
  for (const std::string& part : {parts.side, parts.up})
    (void)rest.cut_top(widgets::draw_afar(ui, rest, widgets::kText, part));
  (void)rest.cut_top(ui.theme.px(8));
  draw_number(ui, rest, "Angle", widgets::fixed(g.angle_deg, 1) + "\u00B0",
              widgets::plus_minus(g.sigma_angle_deg),
              guidance_severity::severity_of(screen.display.grades.angle));
  (void)rest.cut_top(ui.theme.px(8));
  draw_unverified(ui, rest, screen);
  draw_depth(ui, rest, screen);
}

// Said of a drill that is seen alone: a guide does not know how deep the drill is that runs through it.
void draw_depth(const widgets::Ui& ui, widgets::Rect& rest, const NavigateScreen& screen) {
  const auto& drill = screen.display.drill;
  ui.log.note_state("drill", drill_state(screen));
  const auto draw_exit = [&] {
    const guidance_severity::DrillText text = guidance_severity::drill_text(*drill);
    draw_number(ui, rest, text.name, text.mm, "mm", guidance_severity::severity_of_drill(*drill));
  };
  const std::string which = drill_name(screen);
  if (drill && drill->is_at_plan()) {
    // Which of several it is takes the room that the numbers leave, else that behind "Depth".
    const float number = ui.theme.afar->FontSize + ui.theme.number->FontSize;
    const float free = rest.height - (rest.height < 2 * number ? number : 2 * number);
    const bool is_above = !which.empty() && free >= ui.theme.strong->FontSize;
    if (is_above)
      (void)rest.cut_top(widgets::draw_afar(ui, {rest.x, rest.y, rest.width, free}, widgets::kText, which));
    draw_exit();
    draw_number(ui, rest, "Depth", widgets::fixed(drill->depth_mm, 1),
                "mm " + widgets::plus_minus(drill->sigma_mm), widgets::Severity::Quiet,
                is_above ? "" : which);
    return;
  }
  if (drill && warns_beside(*drill)) draw_exit();
  // A number that is gone asks for a reason, also where the depth stop is known.
  if (drill)
    (void)rest.cut_top(widgets::draw_afar(ui, rest, widgets::kCaution,
                                          (which.empty() ? "Drill" : which) + " beside the plan"));
  else if (has_drill(screen))
    (void)rest.cut_top(widgets::draw_afar(
        ui, rest, widgets::kQuietText,
        screen.options().tools.has_several_drills() ? "No drill is seen" : "Drill not seen"));
  // The surgeon's reading, not a measurement: nothing is reckoned from it, least of all what remains.
  if (const auto& stop_mm = screen.live->operation->depth_stop_mm)
    draw_number(ui, rest, "Depth stop", widgets::fixed(*stop_mm, 1), "mm, read", widgets::Severity::Quiet);
}

}  // namespace arthronaut::navigate
