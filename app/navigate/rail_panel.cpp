// What leads through the operation: the nine steps, what to do now, why nothing guides, what is tracked.
#include <algorithm>

#include "app/navigate/navigate_panels.h"
#include "app/widgets/afar_text.h"
#include "app/widgets/wrapped_text.h"

namespace arthronaut::navigate {

namespace {

using operation::Step;
using widgets::Severity;

std::string numbered(Step step) { return std::to_string(static_cast<int>(step) + 1) + "  " + name_of(step); }

// What is done is as good as what it came to.
Severity severity_of(const RailStep& step) {
  using Verdict = tunnels::PlanCheck::Verdict;
  return step.verdict == Verdict::Wrong  ? Severity::Bad
         : step.verdict == Verdict::Look ? Severity::Caution
                                         : Severity::Good;
}

// A step by its shape: a tick where it is done, or the sign of what speaks against it, its number else;
// filled where it is now, hollow where it is open, and a small bar alone where something is missing.
void draw_step(const widgets::Ui& ui, const widgets::Rect& place, const RailStep& step, bool is_looked_at) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float label = ui.theme.body->FontSize;
  widgets::Rect box = place;
  const widgets::Rect foot = box.cut_bottom(label + ui.theme.px(4));
  const ImVec2 center = box.center();
  const float radius = std::min(box.width, box.height) / 2 - ui.theme.px(2);
  const bool is_now = step.state == StepState::Now;
  if (step.state == StepState::Done) {
    widgets::draw_sign(draw, center, radius * 0.8F, severity_of(step));
  } else {
    const ImU32 edge = step.state == StepState::Closed ? widgets::kPanelEdge : widgets::kQuietText;
    if (is_now)
      draw.AddRectFilled({center.x - radius, center.y - radius}, {center.x + radius, center.y + radius},
                         widgets::kAccent, ui.theme.px(8));
    else
      draw.AddCircle(center, radius * 0.8F, edge, 32, ui.theme.px(3));
    ImFont* const font = is_now ? ui.theme.afar : ui.theme.title;
    const std::string number = std::to_string(static_cast<int>(step.step) + 1);
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, number.c_str());
    draw.AddText(font, font->FontSize, {center.x - size.x / 2, center.y - size.y / 2},
                 is_now ? widgets::kBackground : edge, number.c_str());
  }
  if (is_looked_at)
    draw.AddRect(place.min(), place.max(), widgets::kCaution, ui.theme.px(6), 0, ui.theme.px(4));
  const std::string name = short_name_of(step.step);
  const float wide = ui.theme.body->CalcTextSizeA(label, 1e9F, 0, name.c_str()).x;
  draw.AddText(ui.theme.body, label, {foot.center().x - wide / 2, foot.y + ui.theme.px(2)},
               is_now ? widgets::kText : widgets::kQuietText, name.c_str());
}

}  // namespace

void draw_rail(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ui.log.note("navigate.rail", area.min(), area.max());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float width = area.width / static_cast<float>(kStepCount);
  const float label = ui.theme.body->FontSize + ui.theme.px(4);
  const float middle = area.y + (area.height - label) / 2;
  draw.AddLine({area.x + width / 2, middle}, {area.x + area.width - width / 2, middle}, widgets::kPanelEdge,
               ui.theme.px(3));
  for (std::size_t i = 0; i < kStepCount; ++i) {
    const widgets::Rect place{area.x + width * static_cast<float>(i), area.y, width, area.height};
    // The line ends at a shape that is not filled.
    const widgets::Rect behind = widgets::fitted({place.x, place.y, place.width, place.height - label}, 1);
    draw.AddCircleFilled(behind.center(), behind.width * 0.42F, widgets::kBackground, 32);
    draw_step(ui, place, screen.rail[i], screen.looked_at == screen.rail[i].step);
  }
}

void draw_words(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("navigate.words", area.min(), area.max());
  const bool is_back = screen.looked_at.has_value();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRectFilled(area.min(), {area.x + ui.theme.px(8), area.y + area.height},
                     is_back ? widgets::kCaution : widgets::kAccent, ui.theme.px(6));
  widgets::Rect inner = area;
  (void)inner.cut_left(ui.theme.px(20));
  widgets::Rect head = inner.cut_top(ui.theme.title->FontSize);
  (void)inner.cut_right(ui.theme.px(12));
  const Step step = screen.looked_at.value_or(step_of_now(screen.rail));
  std::string title = screen.is_exercise ? "Exercise" : numbered(step);
  if (is_back) title += ", once more";
  ImFont* const small = ui.theme.title;
  draw.AddText(small, small->FontSize, head.min(), is_back ? widgets::kCaution : widgets::kAccent,
               title.c_str());
  if (screen.pedal_acts) {
    const char* const key = "Pedal or Space";
    const float wide = small->CalcTextSizeA(small->FontSize, 1e9F, 0, key).x + ui.theme.px(20);
    const widgets::Rect badge = head.cut_right(wide);
    draw.AddRectFilled(badge.min(), badge.max(), IM_COL32(28, 74, 104, 255), ui.theme.px(6));
    draw.AddText(small, small->FontSize, {badge.x + ui.theme.px(10), badge.y}, widgets::kText, key);
  }
  using widgets::sentence;
  // What is missing stands below what is to be done, and takes its room first: it may be why nothing goes on.
  if (!screen.missing.empty()) {
    const std::string missing = sentence(screen.missing);
    const float sign = ui.theme.afar->FontSize;
    (void)inner.cut_bottom(ui.theme.px(6));
    // What it does not need in the letters that fit is left to what is to be done.
    const float next = widgets::afar_height(ui, inner.width, sentence(screen.next_step));
    const float most = std::max(inner.height * 0.6F, inner.height - next);
    ImFont* const font = widgets::font_that_fits(ui.theme, inner.width - sign, most, missing);
    const std::string lines = widgets::wrapped(font, missing, inner.width - sign);
    const float height = font->CalcTextSizeA(font->FontSize, 1e9F, 0, lines.c_str()).y;
    widgets::Rect foot = inner.cut_bottom(std::max(std::min(height, most), sign));
    const Severity severity = screen.is_wrong ? Severity::Bad : Severity::Caution;
    widgets::draw_sign(draw, {foot.x + sign * 0.4F, foot.y + sign / 2}, sign * 0.36F, severity);
    (void)foot.cut_left(sign);
    widgets::draw_afar(ui, foot, widgets::color_of(severity), missing);
  }
  widgets::draw_afar(ui, inner, widgets::kText, sentence(screen.next_step));
}

void draw_reason(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  const NavigateDisplay& display = screen.display;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("navigate.reason", area.min(), area.max());
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  widgets::Rect inner = area.inset(ui.theme.px(18));
  if (!screen.tunnel.empty())
    widgets::draw_afar(ui, inner.cut_top(ui.theme.afar->FontSize * 1.2F), widgets::kAccent, screen.tunnel);
  // A drill that is seen is told of whatever else is missing.
  if (display.drill && screen.has_source()) {
    const float number = ui.theme.afar->FontSize + ui.theme.number->FontSize;
    const float name = screen.options().tools.has_several_drills() ? ui.theme.afar->FontSize : 0;
    widgets::Rect depth = inner.cut_bottom(std::min(2 * number + name, inner.height / 2));
    draw_depth(ui, depth, screen);
  }
  // Before there is a picture nothing is wrong.
  const bool is_amiss = display.has_picture;
  if (is_amiss) draw.AddRect(area.min(), area.max(), widgets::kCaution, ui.theme.px(6), 0, ui.theme.px(5));
  const float radius = ui.theme.afar->FontSize * 0.4F, sign = is_amiss ? 3 * radius : 0;
  widgets::Rect head = inner.cut_top(widgets::afar_height(ui, inner.width - sign, display.headline));
  if (is_amiss) {
    widgets::draw_sign(draw, {head.x + radius, head.y + ui.theme.afar->FontSize / 2}, radius,
                       Severity::Caution);
    (void)head.cut_left(sign);
  }
  widgets::draw_afar(ui, head, is_amiss ? widgets::kCaution : widgets::kText, display.headline);
  (void)inner.cut_top(ui.theme.px(12));
  widgets::draw_afar(ui, inner, widgets::kText, display.detail);
}

void draw_states(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ui.log.note("navigate.states", area.min(), area.max());
  struct State {
    Severity severity;
    std::string name;
  };
  std::vector<State> states;
  if (screen.has_source() && screen.live->picture != nullptr) {
    const operation::OperationState& state = *screen.live->operation;
    const pipeline::FrameResult& frame = state.frame;
    const bool is_live = screen.display.is_live;
    const auto sign = [&](bool is_good, Severity else_is) {
      return !is_live ? Severity::Quiet : is_good ? Severity::Good : else_is;
    };
    // With an outside tracker nothing hangs on the lens.
    const auto& tracker = state.source->pipeline.tools.tracker;
    if (tracker)
      states.push_back({sign(screen.live->tracker_trouble.empty(), Severity::Bad), "Tracker"});
    else
      states.push_back({sign(frame.intrinsics_are_known, Severity::Bad), "Lens"});
    states.push_back({sign(frame.world_is_seen(), Severity::Bad), "Marker"});
    const bool is_of_probe = screen.is_of_probe();
    const auto* tool = state.source->pipeline.tools.find_tool(
        is_of_probe ? state.source->pipeline.probe_name : state.source->pipeline.guide_name);
    const bool is_seen =
        tool != nullptr &&
        (tracker ? tracker::state_of(frame.outside, tool->marker_id) == tracker::BodyState::Tracked
                 : pipeline::body_in(frame, tool->marker_id).camera_from_body.has_value());
    states.push_back({sign(is_seen, Severity::Caution), is_of_probe ? "Probe" : "Guide"});
    const auto standing = state.registration->in_force.standing;
    states.push_back({waits_for_time_out(state) || screen.display.is_unverified ? Severity::Caution
                      : standing == operation::Standing::Stands                 ? sign(true, Severity::Good)
                      : standing == operation::Standing::None                   ? Severity::Quiet
                                                                                : Severity::Bad,
                      "Bone"});
    const bool is_kept = screen.live->record_trouble.empty() && !screen.live->session_folder.empty();
    states.push_back({!is_kept                     ? Severity::Bad
                      : is_under_way(*screen.live) ? Severity::Good
                                                   : Severity::Quiet,
                      screen.live->keeps_video ? "Video" : "Record"});
    if (screen.is_muted || !screen.sound_trouble.empty())
      states.push_back({Severity::Caution, screen.is_muted ? "Muted" : "No sound"});
  }
  if (states.empty()) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  // As far apart as the words leave room for, and no nearer than a sign is wide: rather in smaller letters.
  ImFont* font = nullptr;
  float radius = 0, gap = 0;
  for (ImFont* const letters : {ui.theme.title, ui.theme.strong, ui.theme.body}) {
    font = letters;
    radius = ui.theme.px(13) * letters->FontSize / ui.theme.title->FontSize;
    float words_width = 0;
    for (const State& state : states)
      words_width += 2.6F * radius + font->CalcTextSizeA(font->FontSize, 1e9F, 0, state.name.c_str()).x;
    gap = (area.width - words_width) / static_cast<float>(states.size());
    if (gap >= 1.5F * radius) break;
  }
  float x = area.x;
  for (std::size_t i = 0; i < states.size(); ++i) {
    widgets::draw_sign(draw, {x + radius, area.center().y}, radius, states[i].severity);
    draw.AddText(
        font, font->FontSize, {x + 2.6F * radius, area.center().y - font->FontSize / 2},
        states[i].severity == Severity::Good ? widgets::kText : widgets::color_of(states[i].severity),
        states[i].name.c_str());
    x += 2.6F * radius + font->CalcTextSizeA(font->FontSize, 1e9F, 0, states[i].name.c_str()).x + gap;
  }
}

}  // namespace arthronaut::navigate
