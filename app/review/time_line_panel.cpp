#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "app/review/review_panels.h"
#include "app/widgets/list_rows.h"

namespace arthronaut::review {

namespace {

constexpr ImU32 kTrough = IM_COL32(14, 17, 21, 255);
constexpr double kShownOffset_mm = 6;  // of the offset's graph, as of the bullseye

struct Scale {  // of the time line
  float left, width;
  double from, to;  // frames at its ends
  [[nodiscard]] float x_of(double frame) const {
    return left + width * static_cast<float>((frame - from) / std::max(to - from, 1.0));
  }
  [[nodiscard]] double frame_of(float x) const {
    return from + std::clamp((x - left) / std::max(width, 1.F), 0.F, 1.F) * (to - from);
  }
  [[nodiscard]] bool shows(double frame) const { return frame >= from && frame <= to; }
};

struct Row {
  float y, height;
  [[nodiscard]] float top() const { return y + height * 0.2F; }
  [[nodiscard]] float bottom() const { return y + height * 0.8F; }
};

void draw_name(const widgets::Ui& ui, ImDrawList& draw, float x, const Row& row, const char* name) {
  ImFont* const font = ui.theme.body;
  draw.AddText(font, font->FontSize, {x, row.y + (row.height - font->FontSize) / 2}, widgets::kQuietText,
               name);
}

// Stretches that fall on one pixel are drawn once: there may be hundreds of thousands.
void draw_stretches(ImDrawList& draw, const Scale& scale, const Row& row,
                    const std::vector<Stretch>& stretches, ImU32 color) {
  float begun = 0, ended = -1;
  const auto flush = [&] {
    if (ended >= begun)
      draw.AddRectFilled({begun, row.top()}, {std::max(ended, begun + 1), row.bottom()}, color);
  };
  for (const Stretch& stretch : stretches) {
    if (static_cast<double>(stretch.last) < scale.from || static_cast<double>(stretch.first) > scale.to)
      continue;
    const float x0 = scale.x_of(std::max(static_cast<double>(stretch.first), scale.from));
    const float x1 = scale.x_of(std::min(static_cast<double>(stretch.last) + 1, scale.to));
    if (ended >= begun && x0 <= ended + 1) {
      ended = std::max(ended, x1);
      continue;
    }
    flush();
    begun = x0;
    ended = x1;
  }
  flush();
}

float height_of(const Row& row, double offset_mm) {
  const auto share = static_cast<float>(std::clamp(offset_mm / kShownOffset_mm, 0.0, 1.0));
  return row.bottom() - share * (row.bottom() - row.top());
}

struct Column {  // of pixels
  float x, top, bottom;
};

// What falls on one column is drawn once, as its range, however often it comes and goes there: of two hours
// hundreds of frames do.
class Columns {
 public:
  // The one before, when this begins another.
  std::optional<Column> add(float x, float y) {
    if (!last_ || last_->x != x) return std::exchange(last_, Column{x, y, y});
    last_->top = std::min(last_->top, y);
    last_->bottom = std::max(last_->bottom, y);
    return std::nullopt;
  }
  [[nodiscard]] const std::optional<Column>& last() const { return last_; }

 private:
  std::optional<Column> last_;
};

void draw_today(ImDrawList& draw, const Scale& scale, const Row& row, const ReviewScreen& screen) {
  Columns columns;
  const auto draw_column = [&](const std::optional<Column>& column) {
    if (column)
      draw.AddRectFilled({column->x - 1, column->top - 1}, {column->x + 1, column->bottom + 1},
                         widgets::kCaution);
  };
  for (const TodayFrame& frame : screen.today->frames) {
    if (frame.state != guidance::GuidanceState::Valid) continue;
    const auto at = static_cast<double>(screen.timeline().at_index(frame.index));
    if (scale.shows(at))
      draw_column(
          columns.add(std::floor(scale.x_of(at)), height_of(row, static_cast<double>(frame.offset_mm))));
  }
  draw_column(columns.last());
}

// The offset as the surgeon saw it, and as today's program computes it.
void draw_offsets(const widgets::Ui& ui, ImDrawList& draw, const Scale& scale, const Row& row,
                  const ReviewScreen& screen) {
  draw.AddRectFilled({scale.left, row.top()}, {scale.left + scale.width, row.bottom()}, kTrough);
  const float limit = height_of(row, 1);
  draw.AddLine({scale.left, limit}, {scale.left + scale.width, limit}, IM_COL32(64, 200, 150, 110),
               ui.theme.px(1));
  const auto& frames = screen.timeline().frames();
  const auto last = static_cast<std::size_t>(std::min(scale.to, static_cast<double>(frames.size() - 1)));
  Columns columns;
  std::optional<ImVec2> before;  // the middle of the column that the next one is joined to
  const auto draw_column = [&](const std::optional<Column>& column) {
    if (!column) return;
    const ImVec2 middle{column->x, (column->top + column->bottom) / 2};
    if (before) draw.AddLine(*before, middle, widgets::kAccent, ui.theme.px(2));
    draw.AddLine({column->x, column->bottom + ui.theme.px(1.5F)}, {column->x, column->top}, widgets::kAccent,
                 ui.theme.px(2));
    before = middle;
  };
  std::optional<std::size_t> guided;
  for (auto i = static_cast<std::size_t>(scale.from); i <= last; ++i) {
    if (!frames[i].is_guided()) continue;
    const float x = std::floor(scale.x_of(static_cast<double>(i)));
    // Nothing is joined over a column that has no guidance.
    const bool is_joined =
        guided && (i == *guided + 1 || x <= std::floor(scale.x_of(static_cast<double>(*guided))) + 1);
    draw_column(columns.add(x, height_of(row, static_cast<double>(frames[i].offset_mm))));
    if (!is_joined) before.reset();
    guided = i;
  }
  draw_column(columns.last());
  draw_stretches(draw, scale, {row.top() - ui.theme.px(4), ui.theme.px(10)},
                 beyond_strip(frames, kShownOffset_mm), widgets::kBad);
  if (screen.today != nullptr) draw_today(draw, scale, row, screen);
}

ImU32 color_of(MomentKind kind) {
  switch (kind) {
    case MomentKind::Command:
      return widgets::kText;
    case MomentKind::Step:
      return widgets::kGood;
    case MomentKind::Alarm:
      return widgets::kBad;
    case MomentKind::Note:
      return widgets::kQuietText;
  }
  return widgets::kQuietText;
}

// Each kind has a shape: commands a stroke, steps a disc, alarms a triangle, notes a small ring.
void draw_sign(const widgets::Ui& ui, ImDrawList& draw, const ImVec2& at, MomentKind kind) {
  const float r = ui.theme.px(7);
  const ImU32 color = color_of(kind);
  switch (kind) {
    case MomentKind::Command:
      draw.AddLine({at.x, at.y - r}, {at.x, at.y + r}, color, ui.theme.px(2));
      break;
    case MomentKind::Step:
      draw.AddCircleFilled(at, r, color, 16);
      break;
    case MomentKind::Alarm:
      draw.AddTriangleFilled({at.x, at.y - r}, {at.x + r, at.y + r}, {at.x - r, at.y + r}, color);
      break;
    case MomentKind::Note:
      draw.AddCircle(at, r * 0.6F, color, 12, ui.theme.px(1.5F));
      break;
  }
}

void draw_moment_row(const widgets::Ui& ui, ImDrawList& draw, const Scale& scale, const Row& row,
                     const ReviewScreen& screen) {
  draw.AddRectFilled({scale.left, row.top()}, {scale.left + scale.width, row.bottom()}, kTrough);
  // Alarms last: nothing lies over them.
  for (const MomentKind kind : {MomentKind::Note, MomentKind::Command, MomentKind::Step, MomentKind::Alarm})
    for (const Moment& moment : screen.review.moments)
      if (moment.kind == kind && scale.shows(static_cast<double>(moment.frame)))
        draw_sign(ui, draw, {scale.x_of(static_cast<double>(moment.frame)), row.y + row.height / 2}, kind);
}

void draw_mark_row(const widgets::Ui& ui, ImDrawList& draw, const Scale& scale, const Row& row,
                   const ReviewScreen& screen, float end) {
  ImFont* const font = ui.theme.body;
  float free_from = scale.left;
  // A note that fits on neither side of its mark is cut off; it stands whole in the list of what happened.
  draw.PushClipRect({scale.left, row.y}, {end, row.y + row.height}, true);
  for (const recording::SessionMark& mark : screen.marks) {
    const auto at = static_cast<double>(screen.timeline().at_index(mark.frame));
    if (!scale.shows(at)) continue;
    const float x = scale.x_of(at);
    draw.AddTriangleFilled({x, row.top()}, {x + ui.theme.px(12), row.top() + ui.theme.px(6)},
                           {x, row.top() + ui.theme.px(12)}, widgets::kCaution);
    draw.AddLine({x, row.top()}, {x, row.bottom()}, widgets::kCaution, ui.theme.px(2));
    if (x < free_from) continue;  // notes never lie over each other
    const float width = font->CalcTextSizeA(font->FontSize, 1e9F, 0, mark.note.c_str()).x;
    const float text_x = note_left(x, width, ui.theme.px(16), {free_from, end});
    draw.AddText(font, font->FontSize, {text_x, row.y + (row.height - font->FontSize) / 2}, widgets::kCaution,
                 mark.note.c_str());
    free_from = std::max(x, text_x + width) + ui.theme.px(12);
  }
  draw.PopClipRect();
}

std::vector<Stretch> differing(const ReviewScreen& screen) {
  std::vector<Stretch> stretches;
  for (const std::int64_t index : screen.today->differing_frames) {
    const std::size_t at = screen.timeline().at_index(index);
    if (!stretches.empty() && at <= stretches.back().last + 1)
      stretches.back().last = at;
    else
      stretches.push_back({at, at});
  }
  return stretches;
}

void draw_loop(ImDrawList& draw, const Scale& scale, const Playback& playback, float top, float bottom) {
  if (!playback.from) return;
  const float x0 = scale.x_of(static_cast<double>(*playback.from));
  const float x1 = playback.to ? scale.x_of(static_cast<double>(*playback.to)) : x0 + 2;
  if (const auto seen = within({x0, x1}, {scale.left, scale.left + scale.width}))
    draw.AddRectFilled({seen->from, top}, {seen->to, bottom}, IM_COL32(86, 180, 233, 40));
}

}  // namespace

std::vector<Stretch> beyond_strip(const std::vector<recording::FrameGlance>& frames, double shown_mm) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].is_guided() || static_cast<double>(frames[i].offset_mm) <= shown_mm) continue;
    if (!stretches.empty() && stretches.back().last + 1 == i)
      stretches.back().last = i;
    else
      stretches.push_back({i, i});
  }
  return stretches;
}

std::optional<Span> within(const Span& span, const Span& shown) {
  const Span seen{std::max(span.from, shown.from), std::min(span.to, shown.to)};
  return seen.from < seen.to ? std::optional(seen) : std::nullopt;
}

float note_left(float mark_x, float width, float gap, const NoteRoom& room) {
  const float right = mark_x + gap, left = mark_x - gap - width;
  return right + width <= room.to || left < room.from ? right : left;
}

TimeLineZoom zoomed(const TimeLineZoom& zoom, double about, double factor, double least) {
  const double width = zoom.to - zoom.from;
  const double wanted = std::clamp(width * factor, std::min(least, 1.0), 1.0);
  const double center = zoom.from + std::clamp(about, 0.0, 1.0) * width;
  TimeLineZoom next;
  next.from = std::clamp(center - std::clamp(about, 0.0, 1.0) * wanted, 0.0, 1 - wanted);
  next.to = next.from + wanted;
  return next;
}

std::optional<std::size_t> draw_time_line(const widgets::Ui& ui, const widgets::Rect& area,
                                          const ReviewScreen& screen, TimeLineZoom& zoom) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  const widgets::Rect inner = area.inset(ui.theme.px(16));
  const float names = ui.theme.px(170);
  const double last = static_cast<double>(screen.timeline().frames().size() - 1);
  const Scale scale{inner.x + names, inner.width - names - ui.theme.px(120), zoom.from * last,
                    zoom.to * last};
  ImGui::SetCursorScreenPos({scale.left, inner.y});
  ImGui::InvisibleButton("review.time_line", {std::max(scale.width, 1.F), inner.height});
  ui.log.note("review.time_line", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const ImGuiIO& io = ImGui::GetIO();
  std::optional<std::size_t> wanted;
  if (ImGui::IsItemActive()) wanted = static_cast<std::size_t>(std::lround(scale.frame_of(io.MousePos.x)));
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const double about = static_cast<double>((io.MousePos.x - scale.left) / std::max(scale.width, 1.F));
    zoom = zoomed(zoom, about, std::pow(0.8, static_cast<double>(io.MouseWheel)), 60 / std::max(last, 60.0));
  }

  const auto& tracks = screen.review.tracks;
  const float rows = static_cast<float>(tracks.size()) + 4.5F;
  Row row{inner.y, inner.height / rows};
  const auto next = [&](float heights) { row.y += heights * inner.height / rows; };
  for (const TimeTrack& track : tracks) {
    draw_name(ui, draw, inner.x, row, track.name.c_str());
    draw.AddRectFilled({scale.left, row.top()}, {scale.left + scale.width, row.bottom()}, kTrough);
    draw_stretches(draw, scale, row, track.stretches, track.is_guidance ? widgets::kAccent : widgets::kGood);
    next(1);
  }
  Row graph{row.y, 1.5F * row.height};
  const float line_px = ui.theme.body->FontSize;
  draw_name(ui, draw, inner.x, {graph.y - line_px / 2, graph.height}, "Axis offset");
  draw_name(ui, draw, inner.x, {graph.y + line_px / 2, graph.height}, "red: over 6 mm");
  draw_offsets(ui, draw, scale, graph, screen);
  next(1.5F);
  draw_name(ui, draw, inner.x, row, "What happened");
  draw_moment_row(ui, draw, scale, row, screen);
  next(1);
  draw_name(ui, draw, inner.x, row, "Marks");
  draw_mark_row(ui, draw, scale, row, screen, inner.x + inner.width);
  next(1);
  draw_name(ui, draw, inner.x, row, "Today differs");
  draw.AddRectFilled({scale.left, row.top()}, {scale.left + scale.width, row.bottom()}, kTrough);
  if (screen.today != nullptr) draw_stretches(draw, scale, row, differing(screen), widgets::kCaution);

  draw_loop(draw, scale, screen.playback, inner.y, inner.y + inner.height);
  const auto cursor = static_cast<double>(screen.playback.frame);
  if (scale.shows(cursor)) {
    const float x = scale.x_of(cursor);
    draw.AddLine({x, inner.y - ui.theme.px(4)}, {x, inner.y + inner.height}, widgets::kText, ui.theme.px(3));
  }
  const float right = scale.left + scale.width + ui.theme.px(14);
  widgets::draw_number(draw, ui.theme.strong, {right, inner.y}, widgets::kText,
                       recording::clock_text(screen.timeline().time_s(screen.playback.frame)));
  widgets::draw_number(
      draw, ui.theme.body, {right, inner.y + ui.theme.px(30)}, widgets::kQuietText,
      "of " + recording::clock_text(screen.timeline().time_s(screen.timeline().frames().size() - 1)));
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {right, inner.y + ui.theme.px(58)},
               widgets::kQuietText, speed_text(screen.playback).c_str());
  return wanted;
}

// Whoever has gone to another picture sees what happened there, or last before it. Called where the first of
// the moments is drawn next.
static void follow_playback(const ReviewScreen& screen) {
  const std::vector<Moment>& moments = screen.review.moments;
  int& seen = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("followed"), -1);
  const int now = static_cast<int>(screen.playback.frame);
  if (std::exchange(seen, now) == now || moments.empty()) return;
  const auto after = std::ranges::upper_bound(moments, screen.playback.frame, {}, &Moment::frame);
  const auto first = std::ranges::lower_bound(
      moments, after == moments.begin() ? moments.front().frame : std::prev(after)->frame, {},
      &Moment::frame);
  const float line = ImGui::GetTextLineHeightWithSpacing(), height = ImGui::GetWindowHeight();
  const float top = ImGui::GetCursorPosY() + line * static_cast<float>(first - moments.begin());
  if (top < ImGui::GetScrollY() || top + line > ImGui::GetScrollY() + height)
    ImGui::SetScrollY(std::max(top - height / 3, 0.F));
}

// A line of the list; true: it was clicked on.
static bool draw_line(const widgets::Ui& ui, double time_s, ImU32 color, const std::string& words, int id,
                      bool is_now) {
  ImGui::PushID(id);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  const std::string text = recording::clock_text(time_s) + "  " + words;
  const std::string shown =
      widgets::fitting(ui.theme.body, text, std::max(ImGui::GetContentRegionAvail().x, 1.F));
  const bool is_clicked = ImGui::Selectable(shown.c_str(), is_now);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopID();
  return is_clicked;
}

static void begin_moments(const widgets::Ui& ui, std::size_t count) {
  ImGui::BeginChild("review.moments");
  ui.log.note("review.moments", ImGui::GetWindowPos(),
              {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(),
               ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
  ui.log.note_state("review_moments", std::to_string(count));
}

void draw_moments_without_frames(const widgets::Ui& ui, const std::vector<Moment>& moments) {
  begin_moments(ui, moments.size());
  int id = 0;
  for (const Moment& moment : moments)
    (void)draw_line(ui, moment.time_s, color_of(moment.kind), moment.words, id++, false);
  ImGui::EndChild();
}

std::optional<std::size_t> draw_moments(const widgets::Ui& ui, const ReviewScreen& screen) {
  std::optional<std::size_t> wanted;
  begin_moments(ui, screen.review.moments.size());
  const auto line = [&](std::size_t frame, double time_s, ImU32 color, const std::string& words, int id) {
    if (draw_line(ui, time_s, color, words, id, frame == screen.playback.frame)) wanted = frame;
  };
  int id = 0;
  for (const recording::SessionMark& mark : screen.marks) {
    const std::size_t frame = screen.timeline().at_index(mark.frame);
    line(frame, screen.timeline().time_s(frame), widgets::kCaution,
         "Mark" + (mark.note.empty() ? std::string() : ": " + mark.note), id++);
  }
  if (!screen.marks.empty()) ImGui::Separator();
  follow_playback(screen);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(screen.review.moments.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const Moment& moment = screen.review.moments[static_cast<std::size_t>(i)];
      line(moment.frame, moment.time_s, color_of(moment.kind), moment.words, id + i);
    }
  ImGui::EndChild();
  return wanted;
}

}  // namespace arthronaut::review
