#include <algorithm>
#include <array>

#include "app/guidance_severity/guidance_severity.h"
#include "app/review/review_view.h"

namespace arthronaut::review {

namespace {

struct Scale {  // of the time line
  float left, width;
  std::size_t count;
  [[nodiscard]] float x_of(std::size_t frame) const {
    return left + width * static_cast<float>(frame) / static_cast<float>(std::max<std::size_t>(count - 1, 1));
  }
  [[nodiscard]] std::size_t frame_of(float x) const {
    const float part = std::clamp((x - left) / std::max(width, 1.F), 0.F, 1.F);
    return static_cast<std::size_t>(part * static_cast<float>(count - 1) + 0.5F);
  }
};

void draw_tracks(const widgets::Ui& ui, ImDrawList& draw, const widgets::Rect& area, const Scale& scale,
                 const std::vector<TimeTrack>& tracks, float row) {
  float y = area.y;
  for (const TimeTrack& track : tracks) {
    draw.AddText(ui.theme.body, ui.theme.body->FontSize, {area.x, y + (row - ui.theme.body->FontSize) / 2},
                 widgets::kQuietText, track.name.c_str());
    const float top = y + row * 0.22F, bottom = y + row * 0.78F;
    draw.AddRectFilled({scale.left, top}, {scale.left + scale.width, bottom}, IM_COL32(14, 17, 21, 255));
    for (const Stretch& stretch : track.stretches)
      draw.AddRectFilled({scale.x_of(stretch.first), top},
                         {std::max(scale.x_of(stretch.last), scale.x_of(stretch.first) + 1), bottom},
                         track.name == "Guidance" ? widgets::kAccent : widgets::kGood);
    y += row;
  }
}

std::string clock_text(double seconds) {
  const long tenths = std::lround(seconds * 10);
  const long minutes = tenths / 600;
  const std::string rest = std::to_string(tenths / 10 % 60);
  return std::to_string(minutes) + ":" + (rest.size() < 2 ? "0" : "") + rest + "." +
         std::to_string(tenths % 10);
}

void draw_events(const widgets::Ui& ui, ImDrawList& draw, const widgets::Rect& area, const Scale& scale,
                 const SessionReview& review, float y) {
  const auto& frames = review.session->frames();
  float free_from = 0;
  for (const recording::SessionEvent& event : review.session->events()) {
    const auto at = std::lower_bound(
        frames.begin(), frames.end(), event.timestamp_ns,
        [](const recording::RecordedFrame& f, std::int64_t t) { return f.timestamp_ns < t; });
    const float x = scale.x_of(std::min(static_cast<std::size_t>(at - frames.begin()), frames.size() - 1));
    draw.AddLine({x, area.y}, {x, y + ui.theme.px(6)}, widgets::kCaution, ui.theme.px(1.5F));
    const float width = ui.theme.body->CalcTextSizeA(ui.theme.body->FontSize, 1e9F, 0, event.kind.c_str()).x;
    const bool fits_right = x + width + ui.theme.px(4) <= area.x + area.width;
    const float text_x = fits_right ? x + ui.theme.px(4) : x - width - ui.theme.px(4);
    if (text_x < free_from) continue;  // names never lie over each other
    draw.AddText(ui.theme.body, ui.theme.body->FontSize, {text_x, y + ui.theme.px(4)}, widgets::kCaution,
                 event.kind.c_str());
    free_from = text_x + width + ui.theme.px(12);
  }
}

void draw_difference(const widgets::Ui& ui, const char* name, const operation::TunnelDifference& d) {
  widgets::text_in(ui.theme.strong, widgets::kText, name);
  widgets::text_in(ui.theme.body, widgets::kText,
                   "entry " + widgets::fixed(d.entry_mm, 1) + " mm, axis " +
                       widgets::fixed(d.axis_to_entry_mm, 1) + " mm, angle " +
                       widgets::fixed(d.angle_deg, 1) + "\u00B0");
}

void draw_achieved(const widgets::Ui& ui, const SessionReview& review) {
  widgets::text_in(ui.theme.title, widgets::kText, "Planned and achieved");
  if (!review.achieved_problem.empty())
    return widgets::status_row(ui, widgets::Severity::Bad, "Not readable", review.achieved_problem);
  if (review.achieved.empty())
    return widgets::text_in(ui.theme.body, widgets::kQuietText, "No tunnel was recorded as drilled.");
  for (const operation::AchievedTunnel& achieved : review.achieved) {
    if (achieved.planned.bundle != norms::Bundle::Whole)
      widgets::text_in(ui.theme.strong, widgets::kText, tunnels::name_of(achieved.planned.key()) + " tunnel");
    draw_difference(ui, "As navigation measured it", operation::compare(achieved.planned, achieved.measured));
    if (achieved.truth)
      draw_difference(ui, "As it truly is (simulated)",
                      operation::compare(achieved.planned, *achieved.truth));
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     achieved.depth_mm.value_or(0) > 1
                         ? "Depth " + widgets::fixed(*achieved.depth_mm, 1) + " mm"
                         : "Depth not known");
  }
}

}  // namespace

std::optional<std::size_t> draw_time_line(const widgets::Ui& ui, const widgets::Rect& area,
                                          const SessionReview& review, const ReviewCursor& cursor) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  const widgets::Rect inner = area.inset(ui.theme.px(16));
  const float names = ui.theme.px(170);
  const Scale scale{inner.x + names, inner.width - names - ui.theme.px(90), review.session->frames().size()};
  const float events = ui.theme.px(40);
  const float row = (inner.height - events) / static_cast<float>(review.tracks.size());
  ImGui::SetCursorScreenPos({scale.left, inner.y});
  ImGui::InvisibleButton("review.time_line", {std::max(scale.width, 1.F), inner.height});
  ui.log.note("review.time_line", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  std::optional<std::size_t> wanted;
  if (ImGui::IsItemActive()) wanted = scale.frame_of(ImGui::GetIO().MousePos.x);
  draw_tracks(ui, draw, inner, scale, review.tracks, row);
  draw_events(ui, draw, inner, scale, review, inner.y + inner.height - events);
  const float x = scale.x_of(cursor.frame);
  draw.AddLine({x, inner.y - ui.theme.px(4)}, {x, inner.y + inner.height - events + ui.theme.px(6)},
               widgets::kText, ui.theme.px(3));
  const std::string time = clock_text(time_s(*review.session, cursor.frame));
  widgets::draw_number(draw, ui.theme.strong, {scale.left + scale.width + ui.theme.px(14), inner.y},
                       widgets::kText, time);
  return wanted;
}

void draw_moment(const widgets::Ui& ui, const widgets::Rect& area, const SessionReview& review,
                 std::size_t frame) {
  const recording::RecordedFrame& at = review.session->frames()[frame];
  widgets::begin_panel(ui, "review.moment", area, "At this moment");
  if (at.guidance.is_valid()) {
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(104);
    widgets::Rect row{cursor.x, cursor.y, width, height};
    const widgets::Rect left = row.cut_left(width / 2);
    widgets::number_block(ui, left, "Offset", widgets::fixed(guidance_severity::offset_mm(at.guidance), 1),
                          "mm", guidance_severity::severity_of_offset(at.guidance));
    widgets::number_block(ui, row, "Angle", widgets::fixed(at.guidance.angle_deg, 1) + "\u00B0", "",
                          guidance_severity::severity_of_angle(at.guidance));
    widgets::Rect below{cursor.x, cursor.y + height, width, height};
    const widgets::Rect below_left = below.cut_left(width / 2);
    // Of a drill with a marker of its own; nobody saw how deep another one was.
    const auto& drill = at.guidance.drill;
    widgets::number_block(ui, below_left, "Drill depth",
                          drill ? widgets::fixed(drill->depth_mm, 1) : "\u2013", drill ? "mm" : "",
                          widgets::Severity::Quiet);
    widgets::number_block(ui, below, "Remaining", drill ? widgets::fixed(drill->remaining_mm, 1) : "\u2013",
                          drill ? "mm" : "", widgets::Severity::Quiet);
    ImGui::Dummy({width, 2 * height});
  } else {
    widgets::status_row(ui, widgets::Severity::Quiet, "No guidance",
                        std::string(guidance::to_text(at.guidance.state)));
  }
  const auto& registration = review.session->registration();
  if (!registration)
    widgets::status_row(ui, widgets::Severity::Quiet, "Registration", "none");
  else if (registration->reliable)
    widgets::status_row(ui, widgets::Severity::Good, "Registration",
                        "target " + widgets::plus_minus(registration->predicted_tre_mm) + " mm");
  else
    widgets::status_row(ui, widgets::Severity::Bad, "Registration",
                        registration->reasons.empty() ? "not reliable" : registration->reasons.front());
  ImGui::Separator();
  draw_achieved(ui, review);
  widgets::end_panel();
}

}  // namespace arthronaut::review
