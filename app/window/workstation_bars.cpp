// The bars above and below every screen.
#include <algorithm>
#include <utility>

#include "app/widgets/list_rows.h"
#include "app/widgets/source_banner.h"
#include "app/widgets/wrapped_text.h"
#include "app/window/whose_knee.h"
#include "app/window/workstation_window.h"

namespace arthronaut::window {

namespace {

constexpr const char* kNotice = "Research software, not a medical device";
constexpr const char *kNoticeBeginning = "Research software,", *kNoticeEnd = "not a medical device";

std::string in_one_line(std::string words) {
  std::ranges::replace(words, '\n', ' ');
  return words;
}

}  // namespace

std::string WorkstationWindow::name_or_live_mode() const {
  for (const auto& mode : modes_)
    if (mode->source_kind() == sources::SourceKind::Live && mode->pictures_are_of_now())
      return "Live in " + std::string(mode->title().label);
  return "Arthronaut";
}

void WorkstationWindow::draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  draw.AddLine({area.x, area.y + area.height}, area.max(), widgets::kPanelEdge);
  const float middle = area.y + area.height / 2;
  const ImFont* title = ui.theme.title;
  const float width = ui.theme.px(156), height = ui.theme.px(50);
  const widgets::Rect heart{area.x + ui.theme.px(14), middle - height / 2, height, height};
  widgets::draw_heartbeat(ui, heart, heartbeat_);
  // The same place in all modes: where the pictures come from, or else whose screen this is.
  const widgets::Rect name{heart.x + heart.width + ui.theme.px(10), middle - ui.theme.px(29),
                           ui.theme.px(330), ui.theme.px(58)};
  if (const auto kind = shows_start() || shows_paint() ? std::nullopt : shown().source_kind())
    widgets::draw_source_word(ui, name, *kind, shown().pictures_are_of_now());
  else
    draw.AddText(title, title->FontSize, {name.x, middle - title->FontSize / 2}, widgets::kText,
                 name_or_live_mode().c_str());
  float x = name.x + name.width + ui.theme.px(12);
  for (const auto& mode : modes_) {
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, mode->title().action, width, height);
    x += width + ui.theme.px(8);
  }
  if (case_ == nullptr || opens_another()) {
    ui.log.note_state("whose", "");
  } else {
    const cases::Case& knee = is_unpainted() ? *case_->unpainted() : model()->knee();
    const float right = area.x + area.width - ui.theme.px(458), room = right - x - ui.theme.px(8);
    const std::vector<WhoseLine> lines = whose_knee(case_->identity(), knee.name, knee.side);
    ImFont* const font = lines.size() > 2 ? ui.theme.body : ui.theme.strong;  // three have no more room
    const float row = font->FontSize;
    const auto width_of = [&](const std::string& words) {
      return font->CalcTextSizeA(row, 1e9F, 0, words.c_str()).x;
    };
    float y = middle - row * static_cast<float>(lines.size()) / 2;
    std::string whole;
    for (const WhoseLine& line : lines) {
      // Where even what is never cut has no room beside the modes, the side at its end is what stays.
      const std::string words =
          width_of(line.rest) > room
              ? widgets::fitting_end(font, line.rest, room)
              : widgets::fitting(font, line.may_be_cut, room - width_of(line.rest)) + line.rest;
      const ImVec2 at{right - width_of(words), y};
      const bool is_quiet = !line.is_of_patient && lines.front().is_of_patient;
      draw.AddText(font, row, at, is_quiet ? widgets::kQuietText : widgets::kText, words.c_str());
      ui.log.note("app.whose", at, {right, y + row});
      whole += (whole.empty() ? "" : " / ") + words;
      y += row;
    }
    ui.log.note_state("whose", whole);
  }
  x = area.x + area.width - ui.theme.px(12);
  for (const auto& [id, size] : {std::pair{"app.quit", 150.F}, {"app.keys", 126.F}, {"app.cases", 136.F}}) {
    x -= ui.theme.px(size);
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, id, ui.theme.px(size), height);
    x -= ui.theme.px(8);
  }
}

std::pair<std::string, bool> WorkstationWindow::status_words() {
  const std::string standstill = heartbeat_.words();
  const std::string fault = fault_.words(widgets::GraphicsWindow::now_s());
  const std::string untaken = untaken_.words(widgets::GraphicsWindow::now_s());
  // What threatens comes before what was asked for in vain.
  const std::string notice = !fault.empty()                   ? fault
                             : !standstill.empty()            ? standstill
                             : !failure_.empty()              ? failure_
                             : !untaken.empty()               ? untaken
                             : shows_start() || shows_paint() ? std::string()
                             : !shown().notice().empty()      ? shown().notice()
                                                              : slow_.words();
  // What leaves the screen is said beside whatever else there is to say.
  const std::string copied = copies_.words(widgets::GraphicsWindow::now_s());
  if (!notice.empty()) return {copied.empty() ? notice : notice + ".  " + copied, true};
  if (!copied.empty()) return {copied, true};
  if (case_ == nullptr || opens_another()) return {room_.trouble(), !room_.trouble().empty()};
  if (case_->is_read_only()) return {"READ-ONLY: the case " + case_->read_only_reason(), true};
  // A pedal that will not do what it was told to is not to be found out in the operation.
  if (const std::string trouble = room_.trouble(); !trouble.empty()) return {trouble, true};
  // No warning, and in the words of whoever works with the case: nothing is to be done about it, and what can
  // be resumed is offered.
  const std::string notice_of_case = case_->notice();
  if (notice_of_case.empty()) return {case_->folder().string(), false};
  return {case_->left_by_crash_since().empty() ? notice_of_case
                                               : "Not closed the last time: all that was saved is here",
          false};
}

void WorkstationWindow::draw_header(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  widgets::Rect rest = area;
  const widgets::Rect foot = rest.cut_bottom(ui.theme.body->FontSize + ui.theme.px(4));
  const float side = std::min(rest.height, ui.theme.px(50));
  widgets::draw_heartbeat(ui, {rest.x, rest.center().y - side / 2, side, side}, heartbeat_);
  (void)rest.cut_left(side, ui.theme.px(10));
  if (const auto kind = shown().source_kind())
    (void)rest.cut_left(widgets::draw_source_word(ui, rest, *kind, shown().pictures_are_of_now()),
                        ui.theme.px(14));
  ImFont* const font = ui.theme.body;
  const auto [text, warns] = status_words();
  const auto width_of = [&](const std::string& words) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
  };
  const float gap = ui.theme.px(20), standing = width_of(kNotice) + gap;
  // What is to be said now is said whole: what always stands there goes up to the right, and never away.
  const bool has_room = !warns || standing + width_of(text) <= foot.width;
  if (has_room) {
    draw.AddText(font, font->FontSize, foot.min(), widgets::kQuietText, kNotice);
    ui.log.note("app.notice", foot.min(), {foot.x + standing, foot.y + font->FontSize});
  } else {
    const float width = width_of(kNoticeEnd);
    const ImVec2 at{area.x + area.width - width, rest.y + ui.theme.px(4)};
    draw.AddText(font, font->FontSize, at, widgets::kQuietText, kNoticeBeginning);
    draw.AddText(font, font->FontSize, {at.x, at.y + font->FontSize}, widgets::kQuietText, kNoticeEnd);
    ui.log.note("app.notice", at, {at.x + width, at.y + 2 * font->FontSize});
    rest.width = at.x - gap - rest.x;
  }
  // Whose knee it is: the side, and the patient as far as known. A long name is cut short, no birth date.
  const cases::Case& knee = model()->knee();
  const std::string side_words = std::string(bones::to_text(knee.side)) + " knee";
  // A birth date tells two of one name apart and comes before a number, which nobody knows by heart.
  const WhoseLine of_case = line_of_case(knee.name);
  std::string name = of_case.may_be_cut, born = of_case.rest;
  if (const auto& identity = case_->identity()) {
    name = identity->name_in_words();
    born.clear();
    for (const std::string& part : {identity->birth_date_in_words(), identity->patient_id})
      if (!part.empty()) born += (name.empty() && born.empty() ? "" : " \u00B7 ") + part;
  }
  const auto line = [&](const char* id, ImFont* of, float y, ImU32 color, const std::string& may_be_cut,
                        const std::string& whole) {
    const auto wide = [&](const std::string& words) {
      return of->CalcTextSizeA(of->FontSize, 1e9F, 0, words.c_str()).x;
    };
    std::string words = widgets::fitting(of, may_be_cut, rest.width - wide(whole)) + whole;
    // What stands beside it is never written over: rather the end is cut, where even that has no room.
    if (wide(words) > rest.width) words = widgets::fitting(of, words, rest.width);
    draw.AddText(of, of->FontSize, {rest.x, y}, color, words.c_str());
    ui.log.note(id, {rest.x, y},
                {rest.x + of->CalcTextSizeA(of->FontSize, 1e9F, 0, words.c_str()).x, y + of->FontSize});
  };
  line("app.side", ui.theme.title, rest.y, widgets::kText, "", side_words);
  line("app.whose", ui.theme.strong, rest.y + ui.theme.title->FontSize, widgets::kQuietText, name, born);
  // In one line beside what always stands there; else whole, in two lines of smaller letters, of which the
  // second stands in the gap below the header.
  const float left = foot.x + (has_room ? standing : 0);
  const widgets::LinesWithin said = widgets::lines_within(font, warns ? text : "", foot.x + foot.width - left,
                                                          foot.height + (has_room ? 0 : ui.theme.px(11)));
  ui.log.note_state("header_notice", in_one_line(said.lines));
  draw.AddText(font, said.letters_px, {left, foot.y}, widgets::kCaution, said.lines.c_str());
}

void WorkstationWindow::draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  ImFont* font = ui.theme.body;
  const float y = area.y + (area.height - font->FontSize) / 2;
  const auto width_of = [&](const std::string& words) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
  };
  const float edge = ui.theme.px(20), standing = edge + width_of(kNotice);
  draw.AddText(font, font->FontSize, {area.x + edge, y}, widgets::kQuietText, kNotice);
  ui.log.note("app.notice", {area.x + edge, y}, {area.x + standing, y + font->FontSize});
  const auto [text, warns] = status_words();
  ui.log.note_state("status", (warns ? "warns: " : "") + text);
  // Beside what always stands there. Of a folder its end tells which it is; a warning stands whole, in
  // smaller letters where it is long.
  const float room = area.width - standing - 2 * edge;
  if (ImFont* const large = ui.theme.title;
      warns && large->CalcTextSizeA(large->FontSize, 1e9F, 0, text.c_str()).x <= room)
    font = large;
  const widgets::LinesWithin said =
      warns ? widgets::lines_within(font, text, room, area.height)
            : widgets::LinesWithin{widgets::fitting_end(font, text, room), font->FontSize};
  const ImVec2 size = font->CalcTextSizeA(said.letters_px, 1e9F, 0, said.lines.c_str());
  const ImVec2 at{area.x + area.width - edge - size.x, area.y + (area.height - size.y) / 2};
  draw.AddText(font, said.letters_px, at, warns ? widgets::kCaution : widgets::kQuietText,
               said.lines.c_str());
  if (!said.lines.empty()) ui.log.note("app.status", at, {at.x + size.x, at.y + size.y});
}

void WorkstationWindow::draw_fault(const widgets::Ui& ui) const {
  ui.log.note_state("frame_fault", fault_.words(ui.now_s));
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float height = ui.theme.body->FontSize + ui.theme.px(16), left = ui.theme.px(20);
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({0, size.y - height}, size, widgets::kPanel);
  const std::string words = widgets::fitting(ui.theme.body, fault_.words(ui.now_s), size.x - 2 * left);
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {left, size.y - height + ui.theme.px(8)},
               widgets::kCaution, words.c_str());
}

}  // namespace arthronaut::window
