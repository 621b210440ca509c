#include <algorithm>
#include <cctype>

#include "app/navigate/navigate_panels.h"
#include "app/navigate/tracking_words.h"
#include "app/widgets/afar_text.h"

namespace arthronaut::navigate {

namespace {

constexpr std::size_t kShownStrokes = 4, kShownHistory = 3;

void draw_bar(const widgets::Ui& ui, double progress, widgets::Severity severity) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.F), height = ui.theme.px(14);
  draw.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(14, 17, 21, 255), height / 2);
  const float done = width * static_cast<float>(progress);
  const ImU32 color = severity == widgets::Severity::Good ? widgets::kGood : widgets::kAccent;
  if (done > height) draw.AddRectFilled(at, {at.x + done, at.y + height}, color, height / 2);
  ImGui::Dummy({width, height});
}

void draw_state(const widgets::Ui& ui, const RegistrationWords& words) {
  const SeverityText& state = words.state;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float radius = ui.theme.px(12);
  widgets::draw_sign(*ImGui::GetWindowDrawList(), {at.x + radius, at.y + ui.theme.title->FontSize / 2},
                     radius, state.severity);
  ImGui::Indent(3 * radius);
  widgets::text_in(
      ui.theme.title,
      state.severity == widgets::Severity::Quiet ? widgets::kText : widgets::color_of(state.severity),
      state.name);
  ImGui::Unindent(3 * radius);
  draw_bar(ui, words.progress, state.severity);
  widgets::text_in(ui.theme.strong, widgets::kText, state.text);
  if (!words.missing.empty())
    widgets::text_in(ui.theme.body, widgets::kQuietText, "Missing: " + words.missing);
  if (!words.assumed.empty()) widgets::text_in(ui.theme.body, widgets::kQuietText, words.assumed);
  for (const SeverityText& row : words.numbers) widgets::status_row(ui, row.severity, row.name, row.text);
}

void draw_touch(const widgets::Ui& ui, const std::optional<TouchText>& touch) {
  if (!touch) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.F);
  const float height = ui.theme.strong->FontSize + ui.theme.number->FontSize;
  widgets::number_block(ui, {at.x, at.y, width, height}, touch->number.name, touch->number.text, "",
                        touch->number.severity);
  ImGui::Dummy({width, height});
  widgets::text_in(ui.theme.body, widgets::kQuietText, touch->sentence);
}

// A few rows of a list about the one that counts, the newest first; it is framed.
template <typename Row, typename IsMarked, typename Draw>
void draw_rows(const widgets::Ui& ui, const std::vector<Row>& rows, std::size_t most,
               const IsMarked& is_marked, const Draw& draw_row) {
  std::size_t marked = rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_marked(i)) marked = i;
  std::size_t end = rows.size();
  if (marked < end) end = std::max(std::min(marked + most / 2 + 1, rows.size()), std::min(most, rows.size()));
  for (std::size_t shown = 0; shown < most && shown < end; ++shown) {
    const std::size_t i = end - 1 - shown;
    const ImVec2 min = ImGui::GetCursorScreenPos();
    draw_row(rows[i]);
    if (i != marked) continue;
    const ImVec2 max{min.x + std::max(ImGui::GetContentRegionAvail().x, 1.F), ImGui::GetItemRectMax().y};
    const float by = ui.theme.px(4);
    ImGui::GetWindowDrawList()->AddRect({min.x - by, min.y - by}, {max.x + by, max.y + by}, widgets::kAccent,
                                        ui.theme.px(6), 0, ui.theme.px(2));
  }
}

void draw_lists(const widgets::Ui& ui, const NavigateScreen& screen) {
  const operation::RegistrationState& status = *screen.live->operation->registration;
  const std::vector<StrokeRow>& strokes = screen.words.strokes;
  if (!strokes.empty()) {
    const std::string count = strokes.size() > kShownStrokes ? ", " + std::to_string(kShownStrokes) + " of " +
                                                                   std::to_string(strokes.size())
                                                             : "";
    widgets::text_in(ui.theme.strong, widgets::kAccent, "Strokes" + count + " (Up, Down)");
    draw_rows(
        ui, strokes, kShownStrokes, [&](std::size_t i) { return strokes[i].curve == screen.selected_stroke; },
        [&](const StrokeRow& row) {
          widgets::status_row(ui, row.text.severity, row.text.name, row.text.text);
        });
  }
  const std::vector<SeverityText>& history = screen.words.history;
  if (history.empty()) return;
  const bool guides = screen.has_source() && status.in_force.standing == operation::Standing::Stands;
  const std::string used = guides && status.entry_in_force
                               ? ", in use: " + std::to_string(*status.entry_in_force + 1)
                               : ", none in use";
  widgets::text_in(ui.theme.strong, widgets::kAccent,
                   "Registrations" + used + (status.is_chosen ? " (chosen)" : ""));
  draw_rows(
      ui, history, kShownHistory, [&](std::size_t i) { return status.entry_in_force == i; },
      [&](const SeverityText& row) { widgets::status_row(ui, row.severity, row.name, row.text); });
}

}  // namespace

void draw_registration(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("navigate.registration", area.min(), area.max());
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  const RegistrationWords& words = screen.words;
  widgets::Rect rest = area.inset(ui.theme.px(14));
  const float line = ui.theme.afar->FontSize;
  // In the order of what matters: what does not fit any more is left out whole.
  const auto put = [&](widgets::Severity severity, ImU32 color, std::string text) {
    if (text.empty()) return true;
    text = widgets::sentence(std::move(text));
    const float indent = severity == widgets::Severity::Quiet ? 0 : line;
    const float height = widgets::afar_height(ui, rest.width - indent, text);
    if (height > rest.height + 1) return false;
    widgets::Rect row = rest.cut_top(height);
    if (indent > 0) widgets::draw_sign(draw, {row.x + line * 0.4F, row.y + line / 2}, line * 0.36F, severity);
    (void)row.cut_left(indent);
    widgets::draw_afar(ui, row, color, text);
    return true;
  };
  const auto put_row = [&](const SeverityText& row) {
    const bool is_quiet = row.severity == widgets::Severity::Quiet;
    put(row.severity, is_quiet ? widgets::kText : widgets::color_of(row.severity), row.name + " " + row.text);
  };
  const SeverityText& state = words.state;
  // A picture that is not of now comes before everything else; what is said of the registration is said once.
  const bool is_told =
      (!screen.display.is_live || !screen.display.world_is_placed) && screen.display.headline != state.name;
  if (is_told) {
    const bool is_amiss = screen.display.has_picture;  // before there is one nothing is
    const bool is_put = put(is_amiss ? widgets::Severity::Caution : widgets::Severity::Quiet,
                            is_amiss ? widgets::kCaution : widgets::kText, screen.display.headline);
    // Why is never left out: rather in smaller letters, and nothing more.
    if (!is_put || !put(widgets::Severity::Quiet, widgets::kText, screen.display.detail)) {
      const std::string& why = screen.display.detail;
      widgets::draw_afar(ui, rest, widgets::kText,
                         is_put ? widgets::sentence(why) : screen.display.headline + ": " + why);
      rest.height = 0;
    }
    (void)rest.cut_top(ui.theme.px(12));
  }
  ui.log.note_state("reason", is_told ? screen.display.detail : "");
  // That strokes are collected, or a registration confirmed, is no word to put behind why nothing can be done
  // with it; and a bar without its word says nothing.
  const bool is_quiet = state.severity == widgets::Severity::Quiet;
  const bool is_well = is_quiet || state.severity == widgets::Severity::Good;
  const bool is_named =
      (!is_told || !is_well) &&
      put(state.severity, is_quiet ? widgets::kText : widgets::color_of(state.severity), state.name);
  ui.log.note_state("registration_says", is_named ? state.name : "");
  // Of what is bad there is no progress: why, and what to do, has its room, or else why alone.
  const bool is_bad = state.severity == widgets::Severity::Bad;
  // Without pictures nothing can be done, and one order is enough: to look after them.
  const bool can_be_done = screen.live->phase != theatre::LiveState::Phase::Ended &&
                           (screen.display.is_live || !screen.display.has_picture);
  if (is_bad && can_be_done && !put(widgets::Severity::Quiet, widgets::kText, state.text)) {
    const auto& in_force = screen.live->operation->registration->in_force.registration;
    if (in_force != nullptr && !in_force->reasons.empty())
      put(widgets::Severity::Quiet, widgets::kText, in_force->reasons.front());
  }
  if (is_named && !is_bad && rest.height > ui.theme.px(24)) {
    ImGui::SetCursorScreenPos(rest.cut_top(ui.theme.px(24)).min());
    ImGui::BeginChild("navigate.progress", {rest.width, ui.theme.px(18)}, false,
                      ImGuiWindowFlags_NoScrollbar);
    draw_bar(ui, words.progress, state.severity);
    ImGui::EndChild();
  }
  if (words.touch) {  // "Touch 1 2.4 mm" is read as one number
    SeverityText touch = words.touch->number;
    touch.name += ':';
    put_row(touch);
  }
  // Where to draw next comes before what is missing, which says the same in figures.
  const bool is_coached = !state.text.empty();
  const bool is_said_as_bad = is_bad || !can_be_done;
  std::string advice = is_coached ? state.text : words.missing;
  bool is_said = is_said_as_bad || put(widgets::Severity::Quiet, widgets::kText, advice);
  // Rather the first things that are missing, read from afar, than all of them in small letters: what is
  // left out is told when these are there.
  const auto put_missing = [&] {
    std::string first = words.missing;
    while (!put(widgets::Severity::Quiet, widgets::kText, first)) {
      const std::size_t last_item = first.rfind("; ");
      if (last_item == std::string::npos) return std::string();
      first.resize(last_item);
    }
    return first;
  };
  if (!is_said && !is_coached) {
    const std::string first = put_missing();
    is_said = !first.empty();
    if (is_said) advice = first;
  }
  // What to do is never left out: rather in smaller letters.
  if (!is_said && rest.height >= ui.theme.strong->FontSize) {
    widgets::draw_afar(ui, rest, widgets::kText, widgets::sentence(advice));
    rest.height = 0;
    is_said = true;
  }
  if (is_coached && is_said && !is_said_as_bad)
    if (const std::string first = put_missing(); !first.empty()) advice += ' ' + first;
  ui.log.note_state("advice", is_said && !is_said_as_bad ? advice : "");
  for (const SeverityText& row : words.numbers) put_row(row);
  if (!screen.has_source()) return;
  for (const SeverityText& row : contour_rows(*screen.live->operation)) put_row(row);
}

void draw_registration_details(const widgets::Ui& ui, const widgets::Rect& area,
                               const NavigateScreen& screen) {
  widgets::begin_panel(ui, "navigate.details", area);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(8), ui.theme.px(7)});
  draw_state(ui, screen.words);
  draw_touch(ui, screen.words.touch);
  draw_lists(ui, screen);
  ImGui::PopStyleVar();
  widgets::end_panel();
}

}  // namespace arthronaut::navigate
