// The bars above and below every screen.
#include <utility>

#include "app/widgets/source_banner.h"
#include "app/window/workstation_window.h"

namespace arthronaut::window {

namespace {

constexpr const char* kNotice = "Research software, not a medical device";

}  // namespace

void WorkstationWindow::draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  draw.AddLine({area.x, area.y + area.height}, area.max(), widgets::kPanelEdge);
  const float middle = area.y + area.height / 2;
  const ImFont* title = ui.theme.title;
  const float width = ui.theme.px(162), height = ui.theme.px(50);
  const widgets::Rect heart{area.x + ui.theme.px(14), middle - height / 2, height, height};
  widgets::draw_heartbeat(ui, heart, heartbeat_);
  // The same place in all modes: where the pictures come from, or else whose screen this is.
  const widgets::Rect name{heart.x + heart.width + ui.theme.px(10), middle - ui.theme.px(29),
                           ui.theme.px(330), ui.theme.px(58)};
  if (const auto kind = shows_start() || shows_paint() ? std::nullopt : shown().source_kind())
    widgets::draw_source_word(ui, name, *kind);
  else
    draw.AddText(title, title->FontSize, {name.x, middle - title->FontSize / 2}, widgets::kText,
                 "Arthronaut");
  float x = name.x + name.width + ui.theme.px(12);
  for (const auto& mode : modes_) {
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, mode->title().action, width, height);
    x += width + ui.theme.px(8);
  }
  if (case_ != nullptr) {
    const cases::Case& knee = is_unpainted() ? *case_->unpainted() : model()->knee();
    const std::string text = knee.name + "  \u2013  " + std::string(bones::to_text(knee.side)) + " knee";
    // Whose knee it is stands over the name of the case.
    const std::string patient = case_->identity() ? case_->identity()->in_words() : "";
    const float right = area.x + area.width - ui.theme.px(482);
    const auto line = [&](const ImFont* font, float y, ImU32 color, const std::string& words) {
      const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
      draw.AddText(font, font->FontSize, {right - wide, y}, color, words.c_str());
    };
    const float row = ui.theme.strong->FontSize;
    if (!patient.empty()) line(ui.theme.strong, middle - row, widgets::kText, patient);
    line(ui.theme.strong, patient.empty() ? middle - row / 2 : middle,
         patient.empty() ? widgets::kText : widgets::kQuietText, text);
  }
  x = area.x + area.width - ui.theme.px(12);
  for (const auto& [id, size] : {std::pair{"app.quit", 156.F}, {"app.keys", 140.F}, {"app.cases", 140.F}}) {
    x -= ui.theme.px(size);
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, id, ui.theme.px(size), height);
    x -= ui.theme.px(8);
  }
}

void WorkstationWindow::draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  const ImFont* font = ui.theme.body;
  const float y = area.y + (area.height - font->FontSize) / 2;
  draw.AddText(font, font->FontSize, {area.x + ui.theme.px(20), y}, widgets::kQuietText, kNotice);
  const std::string standstill = heartbeat_.words();
  const std::string notice = !failure_.empty()                ? failure_
                             : !standstill.empty()            ? standstill
                             : shows_start() || shows_paint() ? std::string()
                                                              : shown().notice();
  const std::string access = case_ == nullptr        ? std::string()
                             : case_->is_read_only() ? "READ-ONLY: the case " + case_->read_only_reason()
                                                     : case_->notice();
  const std::string text = !notice.empty()    ? notice
                           : !access.empty()  ? access
                           : case_ != nullptr ? case_->folder().string()
                                              : std::string();
  const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
  draw.AddText(font, font->FontSize, {area.x + area.width - wide - ui.theme.px(20), y},
               notice.empty() && access.empty() ? widgets::kQuietText : widgets::kCaution, text.c_str());
}

}  // namespace arthronaut::window
