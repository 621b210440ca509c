// The trends of the listed cases, and the daily checks of accuracy, as control charts.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "app/start/case_list.h"
#include "app/widgets/list_rows.h"
#include "planning/files/format.h"
#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::start {

namespace {

using library::ControlLimits;
using library::Trend;
using library::TrendPoint;

// What one chart shows, wherever it comes from.
struct Charted {
  std::string unit;  // "mm", "deg", "min"
  int decimals = 2;
  std::vector<TrendPoint> points;
  ControlLimits limits;
  std::optional<double> least, greatest;  // limits that hold whatever is usual
  bool begins_at_nought = true;
  int left_out = 0;  // checks in another medium, or with another ruler

  [[nodiscard]] bool is_all_simulated() const {
    return std::ranges::all_of(points, &TrendPoint::is_simulated);
  }
  [[nodiscard]] std::string number(double value) const {
    return files::format("%.*f", decimals, value) + unit_text();
  }
  [[nodiscard]] std::string unit_text() const { return unit == "deg" ? "\u00B0" : " " + unit; }
  [[nodiscard]] bool is_outside(double value) const {
    return (limits.is_known && (value > limits.upper || value < limits.lower)) ||
           (greatest && value > *greatest) || (least && value < *least);
  }
};

// A round step that cuts such a range into four to ten.
double step_of(double range) {
  const double rough = range / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

struct Chart {
  widgets::Rect plot;
  double bottom = 0, top = 1;  // the values at the plot's edges
  std::size_t count = 1;

  [[nodiscard]] float y_of(double value) const {
    return plot.y + plot.height * static_cast<float>((top - value) / (top - bottom));
  }
  [[nodiscard]] ImVec2 at(std::size_t i, double value) const {
    const float share = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.5F;
    return {plot.x + plot.width * (0.02F + 0.96F * share), y_of(value)};
  }
};

// As high as everything on it, with some room.
void fit(Chart& chart, const Charted& charted) {
  std::vector<double> shown{charted.limits.is_known ? charted.limits.upper : charted.points.front().value,
                            charted.limits.is_known ? charted.limits.lower : charted.points.front().value};
  for (const TrendPoint& point : charted.points) shown.push_back(point.value);
  for (const auto& limit : {charted.least, charted.greatest})
    if (limit) shown.push_back(*limit);
  const auto [least, greatest] = std::minmax_element(shown.begin(), shown.end());
  chart.bottom = charted.begins_at_nought ? 0 : *least - 0.15 * (*greatest - *least);
  chart.top = *greatest + 0.15 * (*greatest - chart.bottom);
  if (!(chart.top > chart.bottom)) chart.top = chart.bottom + 1;
}

void draw_axis(const widgets::Ui& ui, const Chart& chart, const Charted& charted) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const double step = step_of(chart.top - chart.bottom);
  for (double value = step * std::ceil(chart.bottom / step); value <= chart.top; value += step) {
    const float y = chart.y_of(value);
    draw.AddLine({chart.plot.x, y}, {chart.plot.x + chart.plot.width, y}, widgets::kPanelEdge);
    widgets::draw_text(draw, ui.theme.body, chart.plot.x - ui.theme.px(110), y - ui.theme.body->FontSize / 2,
                       widgets::kQuietText, files::format("%.4g", value) + charted.unit_text());
  }
}

void draw_limits(const widgets::Ui& ui, const Chart& chart, const Charted& charted) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float x0 = chart.plot.x, x1 = chart.plot.x + chart.plot.width, dash = ui.theme.px(14);
  for (const auto& limit : {charted.least, charted.greatest})
    if (limit)
      draw.AddLine({x0, chart.y_of(*limit)}, {x1, chart.y_of(*limit)}, widgets::kBad, ui.theme.px(2));
  const ControlLimits& limits = charted.limits;
  if (!limits.is_known) return;
  draw.AddLine({x0, chart.y_of(limits.center)}, {x1, chart.y_of(limits.center)}, widgets::kGood,
               ui.theme.px(2));
  for (const double limit : {limits.lower, limits.upper})
    for (float x = x0; x < x1; x += 2 * dash)
      draw.AddLine({x, chart.y_of(limit)}, {std::min(x + dash, x1), chart.y_of(limit)}, widgets::kCaution,
                   ui.theme.px(2));
}

// The point under the pointer, if any, is told in words.
void draw_points(const widgets::Ui& ui, const Chart& chart, const Charted& charted) {
  const std::vector<TrendPoint>& points = charted.points;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (std::size_t i = 1; i < points.size(); ++i) {
    // Each with the one before it of its own kind.
    for (std::size_t before = i; before-- > 0;) {
      if (!library::is_one_series(points[before], points[i])) continue;
      draw.AddLine(chart.at(before, points[before].value), chart.at(i, points[i].value), widgets::kQuietText,
                   ui.theme.px(1.5F));
      break;
    }
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float radius = ui.theme.px(6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 at = chart.at(i, points[i].value);
    if (points[i].is_simulated)  // hollow: it is no operation, and within no limits of any
      draw.AddCircle(at, radius, widgets::kAccent, 0, ui.theme.px(2));
    else if (charted.is_outside(points[i].value))  // by shape, too: a square
      draw.AddRectFilled({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}, widgets::kBad);
    else if (points[i].bone == bones::BoneKind::Tibia)
      draw.AddTriangleFilled({at.x, at.y - radius}, {at.x + radius, at.y + radius},
                             {at.x - radius, at.y + radius}, widgets::kAccent);
    else
      draw.AddCircleFilled(at, radius, widgets::kAccent);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 at = chart.at(i, points[i].value);
    if (std::hypot(at.x - mouse.x, at.y - mouse.y) > 2 * radius) continue;
    const std::string bone = points[i].bone ? ", " + library::word_of(points[i].bone) : "";
    const std::string words = points[i].case_name + bone + (points[i].is_simulated ? ", simulated, " : ", ") +
                              files::local_day(points[i].when_utc) + ": " + charted.number(points[i].value);
    ImGui::SetTooltip("%s", words.c_str());
    break;
  }
}

Charted charted_trend(std::span<const library::CaseRecord> listed, Trend trend,
                      const library::TrendOptions& options) {
  Charted charted;
  charted.unit = library::unit_of(trend);
  charted.points = library::trend_of(listed, trend, options);
  charted.limits = library::limits_of(charted.points);
  return charted;
}

Charted charted_accuracy(std::span<const library::AccuracyCheck> checks,
                         const library::AccuracyDevice& device, const std::string& now_utc) {
  Charted charted;
  charted.unit = "mm";
  charted.decimals = 3;
  library::AccuracyTrend trend = library::accuracy_trend(checks, device, now_utc);
  charted.points = std::move(trend.points);
  charted.left_out = trend.left_out;
  const library::AccuracyStanding standing = library::accuracy_standing(checks, device, now_utc);
  charted.limits = standing.limits;
  charted.least = standing.true_mm - library::kMostDistanceError_mm;
  charted.greatest = standing.true_mm + library::kMostDistanceError_mm;
  charted.begins_at_nought = false;
  return charted;
}

std::string limits_in_words(const Charted& charted, const std::string& fewer) {
  if (!charted.limits.is_known) return ".  Limits from " + fewer + " on";
  const auto outside =
      std::count_if(charted.points.begin(), charted.points.end(), [&](const TrendPoint& point) {
        return point.is_simulated == charted.is_all_simulated() && charted.is_outside(point.value);
      });
  const bool has_both = std::ranges::any_of(charted.points, &TrendPoint::is_simulated);
  const std::string of = charted.is_all_simulated() ? ".  Of simulations: mean "
                         : has_both                 ? ".  Of the operations alone: mean "
                                                    : ".  Mean ";
  return of + charted.number(charted.limits.center) + ", limits " + charted.number(charted.limits.lower) +
         " to " + charted.number(charted.limits.upper) + ", " + std::to_string(outside) + " outside";
}

void draw_chart(const widgets::Ui& ui, const widgets::Rect& area, const Charted& charted) {
  Chart chart{area.inset(ui.theme.px(50)), 0, 1, charted.points.size()};
  chart.plot.cut_left(ui.theme.px(80));
  fit(chart, charted);
  draw_axis(ui, chart, charted);
  draw_limits(ui, chart, charted);
  draw_points(ui, chart, charted);
  ImDrawList& plot = *ImGui::GetWindowDrawList();
  const float y = chart.plot.y + chart.plot.height + ui.theme.px(10);
  widgets::draw_text(plot, ui.theme.body, chart.plot.x, y, widgets::kQuietText,
                     files::local_day(charted.points.front().when_utc));
  if (charted.points.size() > 1)
    widgets::draw_text(plot, ui.theme.body, chart.plot.x + chart.plot.width - ui.theme.px(130), y,
                       widgets::kQuietText, files::local_day(charted.points.back().when_utc));
}

}  // namespace

std::size_t CaseList::chart_count() const {
  return static_cast<std::size_t>(library::kTrendCount) + devices_.size();
}

std::string CaseList::chart_name(std::size_t chart) const {
  if (chart < static_cast<std::size_t>(library::kTrendCount))
    return std::string(to_text(static_cast<Trend>(chart)));
  return "Daily accuracy: " +
         library::shown_name(accuracy_.checks,
                             devices_[chart - static_cast<std::size_t>(library::kTrendCount)]);
}

void CaseList::draw_chart_list(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "start.trend_list", area);
  for (std::size_t i = 0; i < chart_count(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ui.theme.px(52);
    const widgets::RowPress press = widgets::draw_row(ui, {.name = "start.trend." + std::to_string(i),
                                                           .number = i,
                                                           .height = height,
                                                           .is_selected = i == view_.chart,
                                                           .scrolls_here = false});
    if (press != widgets::RowPress::None) view_.chart = i;
    widgets::draw_text(*ImGui::GetWindowDrawList(), ui.theme.body, at.x + ui.theme.px(14),
                       at.y + (height - ui.theme.body->FontSize) / 2, widgets::kText,
                       widgets::fitting(ui.theme.body, chart_name(i), area.width - ui.theme.px(60)));
  }
  widgets::end_panel();
}

void CaseList::draw_trends(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(96));
  const bool is_accuracy = view_.chart >= static_cast<std::size_t>(library::kTrendCount);
  std::vector<library::CaseRecord> listed;
  if (!is_accuracy)
    for (const std::size_t i : found_) listed.push_back(library_.records()[i]);
  std::size_t left_out = 0;
  Charted charted;
  std::string words;
  if (is_accuracy) {
    const library::AccuracyDevice& device =
        devices_[view_.chart - static_cast<std::size_t>(library::kTrendCount)];
    const std::string now_utc = files::utc_now();
    charted = charted_accuracy(accuracy_.checks, device, now_utc);
    words = library::accuracy_standing(accuracy_.checks, device, now_utc).text +
            limits_in_words(charted, std::to_string(library::kLeastForLimits) + " days");
    if (charted.left_out > 0)
      words += files::format("; %d in another medium or with another ruler left out", charted.left_out);
    if (const auto problems = library::problems_of(accuracy_, now_utc); !problems.empty())
      words += ".  " + problems.front();
  } else {
    const auto trend = static_cast<Trend>(view_.chart);
    charted =
        charted_trend(listed, trend, {.with_simulated = view_.with_simulated, .bone = view_.trend_bone});
    left_out = library::trend_of(listed, trend, {.with_simulated = true, .bone = view_.trend_bone}).size() -
               charted.points.size();
    const std::string one = is_of_comparisons(trend) ? "tunnel in a CT" : "session";
    const std::string many = is_of_comparisons(trend) ? "tunnels in CTs" : "sessions";
    words = (!view_.trend_bone                            ? std::string("Femur (round) and tibia (pointed)")
             : view_.trend_bone == bones::BoneKind::Femur ? "Femur"
                                                          : "Tibia") +
            ": " + std::to_string(charted.points.size()) + " " + (charted.points.size() == 1 ? one : many) +
            " of " + std::to_string(found_.size()) + (found_.size() == 1 ? " listed case" : " listed cases");
    if (left_out > 0) words += "; " + std::to_string(left_out) + " simulated left out";
    if (is_of_comparisons(trend)) {
      const std::size_t unknown =
          library::trend_of(
              listed, trend,
              {.with_simulated = view_.with_simulated, .bone = view_.trend_bone, .of_unknown = true})
              .size();
      if (unknown > 0) words += "; " + std::to_string(unknown) + " in which it is not reliable left out";
    }
    words += limits_in_words(charted, std::to_string(library::kLeastForLimits) + " " + many);
  }
  ui.log.note_state("trend_points", std::to_string(charted.points.size()));
  ui.log.note_state("trend", chart_name(view_.chart));
  ui.log.note_state("trend_says", words);
  ui.log.note_state("trend_bone", view_.trend_bone ? library::word_of(view_.trend_bone) : "both");

  ImDrawList& draw = *ImGui::GetWindowDrawList();
  widgets::draw_text(draw, ui.theme.title, head.x, head.y, widgets::kText, chart_name(view_.chart));
  widgets::draw_text(draw, ui.theme.body, head.x, head.y + ui.theme.px(50), widgets::kQuietText,
                     widgets::fitting(ui.theme.body, words, head.width));
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {"start.trends", "start.trend_bone", "start.simulated", "start.back"});
  draw_chart_list(ui, rest.cut_left(ui.theme.px(420), ui.theme.px(12)));
  widgets::begin_panel(ui, "start.trend_plot", rest);
  const bool is_any_compared =
      std::ranges::any_of(listed, [](const auto& record) { return !record.postoperative.empty(); });
  if (charted.points.empty())
    widgets::text_in(
        ui.theme.strong, widgets::kQuietText,
        left_out > 0 ? "Only simulated sessions say this number: Space counts them."
        : is_accuracy || !is_of_comparisons(static_cast<Trend>(view_.chart))
            ? "No session of the listed cases says this number."
        : is_any_compared
            ? "No tunnel in the CTs after the operation of the listed cases is reliable: none is "
              "counted."
            : "None of the listed cases was compared with a CT after the operation: P in Review.");
  else
    draw_chart(ui, rest, charted);
  widgets::end_panel();
}

}  // namespace arthronaut::start
