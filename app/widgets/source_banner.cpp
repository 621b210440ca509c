#include "app/widgets/source_banner.h"

#include <string>

namespace arthronaut::widgets {

namespace {

constexpr float kFrame_px = 8;  // thinner than the margin that every screen leaves

struct Dash {
  float length_px, gap_px;  // gap 0: a whole line
};

Dash dash_of(sources::SourceKind kind) {
  switch (kind) {
    case sources::SourceKind::Live:
      return {1, 0};
    case sources::SourceKind::Recording:
      return {120, 40};
    case sources::SourceKind::Simulation:
      return {24, 24};
  }
  return {1, 0};
}

void draw_side(ImDrawList& draw, const Rect& side, const Dash& dash, ImU32 color) {
  if (dash.gap_px <= 0) return draw.AddRectFilled(side.min(), side.max(), color);
  Rect rest = side;
  if (side.width > side.height)
    while (rest.width > 0) {
      const Rect part = rest.cut_left(dash.length_px, dash.gap_px);
      draw.AddRectFilled(part.min(), part.max(), color);
    }
  else
    while (rest.height > 0) {
      const Rect part = rest.cut_top(dash.length_px, dash.gap_px);
      draw.AddRectFilled(part.min(), part.max(), color);
    }
}

}  // namespace

std::string_view banner_word(sources::SourceKind kind, bool is_of_now) {
  switch (kind) {
    case sources::SourceKind::Live:
      return is_of_now ? "LIVE" : "NOT LIVE";
    case sources::SourceKind::Recording:
      return "RECORDING";
    case sources::SourceKind::Simulation:
      return "SIMULATION";
  }
  return "";
}

// Apart for every kind of colour vision, and none of them the colour of a verdict.
ImU32 banner_color(sources::SourceKind kind, bool is_of_now) {
  switch (kind) {
    case sources::SourceKind::Live:
      return is_of_now ? IM_COL32(235, 238, 242, 255) : IM_COL32(120, 130, 140, 255);
    case sources::SourceKind::Recording:
      return IM_COL32(230, 159, 0, 255);
    case sources::SourceKind::Simulation:
      return IM_COL32(204, 121, 167, 255);
  }
  return kText;
}

void draw_source_frame(const Ui& ui, const Rect& window, sources::SourceKind kind, bool is_of_now) {
  if (kind == sources::SourceKind::Live && !is_of_now) return;
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  const float width = ui.theme.px(kFrame_px);
  Dash dash = dash_of(kind);
  dash = {ui.theme.px(dash.length_px), ui.theme.px(dash.gap_px)};
  Rect rest = window;
  for (const Rect& side :
       {rest.cut_top(width), rest.cut_bottom(width), rest.cut_left(width), rest.cut_right(width)})
    draw_side(draw, side, dash, banner_color(kind, is_of_now));
}

float draw_source_word(const Ui& ui, const Rect& area, sources::SourceKind kind, bool is_of_now) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* const font = ui.theme.afar;
  const std::string word(banner_word(kind, is_of_now));
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, word.c_str());
  const float margin = ui.theme.px(14);
  const Rect plate{area.x, area.y, size.x + 2 * margin, area.height};
  draw.AddRectFilled(plate.min(), plate.max(), banner_color(kind, is_of_now), ui.theme.px(6));
  draw.AddText(font, font->FontSize, {plate.x + margin, plate.center().y - size.y / 2}, kBackground,
               word.c_str());
  ui.log.note("app.source", plate.min(), plate.max());
  ui.log.note_state("source_kind", word);
  return plate.width;
}

}  // namespace arthronaut::widgets
