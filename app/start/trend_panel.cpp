// The trends of the listed cases as control charts.
#include <algorithm>
#include <cmath>

#include "app/start/case_list.h"
#include "app/start/start_drawing.h"
#include "planning/files/format.h"

namespace arthronaut::start {

namespace {

using library::ControlLimits;
using library::Trend;
using library::TrendPoint;

std::string unit_in_words(Trend trend) {
  const std::string unit(library::unit_of(trend));
  return unit == "deg" ? "\u00B0" : " " + unit;
}

std::string number(double value, Trend trend) { return files::format("%.2f", value) + unit_in_words(trend); }

// A round step that cuts [0, top] into four to ten.
double step_of(double top) {
  const double rough = top / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

struct Chart {
  widgets::Rect plot;
  double top = 1;  // the value at the plot's upper edge; 0 is at the lower
  std::size_t count = 1;

  [[nodiscard]] float y_of(double value) const {
    return plot.y + plot.height * static_cast<float>(1 - value / top);
  }
  [[nodiscard]] ImVec2 at(std::size_t i, double value) const {
    const float share = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.5F;
    return {plot.x + plot.width * (0.02F + 0.96F * share), y_of(value)};
  }
};

void draw_axis(const widgets::Ui& ui, const Chart& chart, Trend trend) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const double step = step_of(chart.top);
  for (double value = 0; value <= chart.top; value += step) {
    const float y = chart.y_of(value);
    draw.AddLine({chart.plot.x, y}, {chart.plot.x + chart.plot.width, y}, widgets::kPanelEdge);
    draw_text(draw, ui.theme.body, chart.plot.x - ui.theme.px(110), y - ui.theme.body->FontSize / 2,
              widgets::kQuietText, files::format("%.4g", value) + unit_in_words(trend));
  }
}

void draw_limits(const widgets::Ui& ui, const Chart& chart, const ControlLimits& limits) {
  if (!limits.is_known) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float x0 = chart.plot.x, x1 = chart.plot.x + chart.plot.width, dash = ui.theme.px(14);
  draw.AddLine({x0, chart.y_of(limits.center)}, {x1, chart.y_of(limits.center)}, widgets::kGood,
               ui.theme.px(2));
  for (const double limit : {limits.lower, limits.upper})
    for (float x = x0; x < x1; x += 2 * dash)
      draw.AddLine({x, chart.y_of(limit)}, {std::min(x + dash, x1), chart.y_of(limit)}, widgets::kCaution,
                   ui.theme.px(2));
}

bool is_outside(double value, const ControlLimits& limits) {
  return limits.is_known && (value > limits.upper || value < limits.lower);
}

// The point under the pointer, if any, is told in words.
void draw_points(const widgets::Ui& ui, const Chart& chart, const std::vector<TrendPoint>& points,
                 const ControlLimits& limits, Trend trend) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (std::size_t i = 1; i < points.size(); ++i)
    draw.AddLine(chart.at(i - 1, points[i - 1].value), chart.at(i, points[i].value), widgets::kQuietText,
                 ui.theme.px(1.5F));
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float radius = ui.theme.px(6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 at = chart.at(i, points[i].value);
    if (is_outside(points[i].value, limits))  // by shape, too: a square
      draw.AddRectFilled({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}, widgets::kBad);
    else
      draw.AddCircleFilled(at, radius, widgets::kAccent);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 at = chart.at(i, points[i].value);
    if (std::hypot(at.x - mouse.x, at.y - mouse.y) > 2 * radius) continue;
    const std::string words =
        points[i].case_name + ", " + points[i].when_utc.substr(0, 10) + ": " + number(points[i].value, trend);
    ImGui::SetTooltip("%s", words.c_str());
    break;
  }
}

}  // namespace

void CaseList::draw_trends(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(96));
  std::vector<library::CaseRecord> listed;
  for (const std::size_t i : found_) listed.push_back(library_.records()[i]);
  const auto points = library::trend_of(listed, view_.trend, {.with_simulated = view_.with_simulated});
  const std::size_t with_simulated = library::trend_of(listed, view_.trend, {.with_simulated = true}).size();
  std::vector<double> values;
  for (const TrendPoint& point : points) values.push_back(point.value);
  const ControlLimits limits = library::control_limits(values);
  ui.log.note_state("trend_points", std::to_string(points.size()));
  ui.log.note_state("trend", std::string(to_text(view_.trend)));

  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw_text(draw, ui.theme.title, head.x, head.y, widgets::kText, std::string(to_text(view_.trend)));
  std::string words = std::to_string(points.size()) +
                      (points.size() == 1 ? " session of " : " sessions of ") +
                      std::to_string(found_.size()) + (found_.size() == 1 ? " listed case" : " listed cases");
  if (!view_.with_simulated && with_simulated > points.size())
    words += "; " + std::to_string(with_simulated - points.size()) + " simulated left out";
  const auto outside =
      std::count_if(values.begin(), values.end(), [&](double value) { return is_outside(value, limits); });
  if (limits.is_known)
    words += ".  Mean " + number(limits.center, view_.trend) + ", limits " +
             number(limits.lower, view_.trend) + " to " + number(limits.upper, view_.trend) + ", " +
             std::to_string(outside) + " outside";
  else
    words += ".  Limits from " + std::to_string(library::kLeastForLimits) + " sessions on";
  draw_text(draw, ui.theme.body, head.x, head.y + ui.theme.px(50), widgets::kQuietText,
            fitting(ui.theme.body, words, head.width));
  draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
               {"start.trends", "start.simulated", "start.back"});

  const widgets::Rect choice = rest.cut_left(ui.theme.px(420), ui.theme.px(12));
  widgets::begin_panel(ui, "start.trend_list", choice);
  for (int i = 0; i < library::kTrendCount; ++i) {
    const auto trend = static_cast<Trend>(i);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ui.theme.px(52);
    const RowPress press = draw_row(ui, {.name = "start.trend." + std::to_string(i),
                                         .number = static_cast<std::size_t>(i),
                                         .height = height,
                                         .is_selected = trend == view_.trend,
                                         .scrolls_here = false});
    if (press != RowPress::None) view_.trend = trend;
    draw_text(*ImGui::GetWindowDrawList(), ui.theme.body, at.x + ui.theme.px(14),
              at.y + (height - ui.theme.body->FontSize) / 2, widgets::kText,
              fitting(ui.theme.body, std::string(to_text(trend)), choice.width - ui.theme.px(60)));
  }
  widgets::end_panel();

  widgets::begin_panel(ui, "start.trend_plot", rest);
  if (points.empty()) {
    widgets::text_in(ui.theme.strong, widgets::kQuietText,
                     with_simulated > 0 ? "Only simulated sessions say this number: Space counts them."
                                        : "No session of the listed cases says this number.");
  } else {
    Chart chart{rest.inset(ui.theme.px(50)), 1, points.size()};
    chart.plot.cut_left(ui.theme.px(80));
    chart.top = 1.15 * std::max(*std::max_element(values.begin(), values.end()), limits.upper);
    if (!(chart.top > 0)) chart.top = 1;
    draw_axis(ui, chart, view_.trend);
    draw_limits(ui, chart, limits);
    draw_points(ui, chart, points, limits, view_.trend);
    ImDrawList& plot = *ImGui::GetWindowDrawList();
    const float y = chart.plot.y + chart.plot.height + ui.theme.px(10);
    draw_text(plot, ui.theme.body, chart.plot.x, y, widgets::kQuietText,
              points.front().when_utc.substr(0, 10));
    if (points.size() > 1)
      draw_text(plot, ui.theme.body, chart.plot.x + chart.plot.width - ui.theme.px(130), y,
                widgets::kQuietText, points.back().when_utc.substr(0, 10));
  }
  widgets::end_panel();
}

}  // namespace arthronaut::start
