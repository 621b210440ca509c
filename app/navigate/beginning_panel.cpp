#include "app/navigate/beginning_panel.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "app/widgets/wrapped_text.h"

namespace arthronaut::navigate {

namespace {

constexpr float kSmaller = 0.94F;  // from one size of letters to the next

// What a line's name takes of the same line as its text, where both fit; 0: it stands above, or there is
// none.
float width_beside(const widgets::Ui& ui, float width, const CardLine& line, float letters_px) {
  if (line.name.empty()) return 0;
  const ImFont* const name = ui.theme.title;
  const float sign = line.severity == widgets::Severity::Quiet ? 0 : name->FontSize * 1.2F;
  const float beside =
      sign + name->CalcTextSizeA(name->FontSize, 1e9F, 0, line.name.c_str()).x + ui.theme.px(18);
  return beside + ui.theme.afar->CalcTextSizeA(letters_px, 1e9F, 0, line.text.c_str()).x <= width ? beside
                                                                                                  : 0;
}

// What a sign takes before the words of a line that has no name; the name of any other stands behind it.
float width_of_sign(const CardLine& line, float letters_px) {
  return line.name.empty() && line.severity != widgets::Severity::Quiet ? 1.2F * letters_px : 0;
}

// As widgets::wrapped() breaks it, which knows the font in its own size alone.
std::string in_lines(const ImFont* font, float size_px, const std::string& words, float width) {
  return widgets::wrapped(font, words, width * font->FontSize / size_px);
}

// The names in small letters, what they say in letters for afar, beside or under them.
float height_of(const widgets::Ui& ui, float width, const Card& card, float letters_px) {
  float height = card.keys.empty() ? 0 : ui.theme.px(10);
  const auto add = [&](const std::string& words, float indent = 0) {
    if (!words.empty())
      height += ui.theme.afar
                    ->CalcTextSizeA(letters_px, 1e9F, 0,
                                    in_lines(ui.theme.afar, letters_px, words, width - indent).c_str())
                    .y;
  };
  add(card.title);
  for (const CardLine& line : card.lines) {
    height += ui.theme.px(8);
    const bool has_own_line = !line.name.empty() && width_beside(ui, width, line, letters_px) <= 0;
    if (has_own_line) height += ui.theme.title->FontSize;
    add(line.text, width_of_sign(line, letters_px));
  }
  add(card.keys);
  return height;
}

}  // namespace

void draw_card(const widgets::Ui& ui, const widgets::Rect& area, const Card& card) {
  ui.log.note(card.name, area.min(), area.max());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), widgets::kAccent, ui.theme.px(6), 0, ui.theme.px(3));
  draw.PushClipRect(area.min(), area.max(), true);
  widgets::Rect box = area.inset(ui.theme.px(16));
  // In smaller letters where there is too much of it: nothing of what is confirmed may be cut off.
  ImFont* const name = ui.theme.title;
  float letters_px = ui.theme.afar->FontSize;
  while (letters_px > ui.theme.strong->FontSize && height_of(ui, box.width, card, letters_px) > box.height)
    letters_px *= kSmaller;
  ui.log.note_state("card_letters", std::to_string(std::lround(100 * letters_px / ui.theme.afar->FontSize)));
  const auto put = [&](ImFont* font, float size_px, ImU32 color, const std::string& words, float indent) {
    if (words.empty()) return;
    const std::string lines = in_lines(font, size_px, words, box.width - indent);
    draw.AddText(font, size_px, {box.x + indent, box.y}, color, lines.c_str());
    (void)box.cut_top(font->CalcTextSizeA(size_px, 1e9F, 0, lines.c_str()).y);
  };
  put(ui.theme.afar, letters_px, widgets::kText, card.title, 0);
  for (const CardLine& line : card.lines) {
    (void)box.cut_top(ui.theme.px(8));
    const bool is_quiet = line.severity == widgets::Severity::Quiet;
    const float radius = name->FontSize * 0.4F, beside = width_beside(ui, box.width, line, letters_px);
    const float lower = beside > 0 ? (letters_px - name->FontSize) * 0.75F : 0;  // on the same base line
    const float sign = width_of_sign(line, letters_px);
    const float beside_px = sign > 0 ? letters_px : name->FontSize;  // of the letters that it stands before
    if (!is_quiet)
      widgets::draw_sign(draw, {box.x + radius, box.y + lower + beside_px / 2}, radius, line.severity);
    const float indent = is_quiet ? 0 : 3 * radius;
    if (beside > 0)
      draw.AddText(name, name->FontSize, {box.x + indent, box.y + lower}, widgets::kQuietText,
                   line.name.c_str());
    else
      put(name, name->FontSize, widgets::kQuietText, line.name, indent);
    put(ui.theme.afar, letters_px, is_quiet ? widgets::kText : widgets::color_of(line.severity), line.text,
        std::max(beside, sign));
  }
  if (!card.keys.empty()) (void)box.cut_top(ui.theme.px(10));
  put(ui.theme.afar, letters_px, widgets::kAccent, card.keys, 0);
  draw.PopClipRect();
}

void DepthEntry::open() {
  text_.clear();
  trouble_.clear();
  is_open_ = wants_focus_ = true;
}

std::optional<double> DepthEntry::draw(const widgets::Ui& ui, const widgets::Rect& video) {
  if (!is_open_) return std::nullopt;
  widgets::Rect rest = video;
  widgets::Rect bar = rest.cut_bottom(ui.theme.px(120));
  ImGui::GetWindowDrawList()->AddRectFilled(bar.min(), bar.max(), IM_COL32(10, 12, 15, 255));
  bar = bar.inset(ui.theme.px(14));
  widgets::text_centered(
      ui, bar.cut_top(ui.theme.px(42)), ui.theme.strong,
      trouble_.empty() ? widgets::kText : widgets::kCaution,
      trouble_.empty() ? "What the drill's depth stop reads, in mm; then Enter" : trouble_);
  ImGui::SetCursorScreenPos(bar.min());
  ImGui::SetNextItemWidth(bar.width);
  if (wants_focus_) ImGui::SetKeyboardFocusHere();
  // Every letter is taken, and the whole judged: ImGui's filter for numbers drops a comma, and 12,5 became
  // 125.
  const bool is_entered = ImGui::InputText("##depth_stop", &text_, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note("navigate.depth_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (is_entered) {
    const std::optional<double> depth_mm = depth_from_text(text_);
    is_open_ = wants_focus_ = !depth_mm;
    text_.clear();  // what is typed next is not added to what was refused
    trouble_ = depth_mm ? "" : "Not a number of millimetres from 0 to 150: once more, then Enter";
    return depth_mm;
  }
  if (!wants_focus_ && ImGui::IsItemDeactivated()) close();
  wants_focus_ = false;
  return std::nullopt;
}

}  // namespace arthronaut::navigate
