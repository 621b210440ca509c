// What Plan says over the bones: a conflict that has to be answered, and what a click did or will do.
#include <algorithm>
#include <cmath>
#include <string>

#include "app/plan/pane_text.h"
#include "app/plan/plan_view.h"
#include "app/widgets/wrapped_text.h"

namespace arthronaut::plan {

// Over the bones, where it is not overlooked: nothing is saved until it is answered.
void PlanView::draw_conflict(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), widgets::kCaution, ui.theme.px(6), 0, ui.theme.px(2));
  const float middle = area.y + area.height / 2, font = ui.theme.strong->FontSize;
  widgets::draw_sign(draw, {area.x + ui.theme.px(26), middle}, ui.theme.px(10), widgets::Severity::Caution);
  const float height = ui.theme.px(44), width = ui.theme.px(206), left = area.x + ui.theme.px(50),
              room = area.width - 2 * width - ui.theme.px(80), top = area.y + ui.theme.px(6);
  const std::string words = history_.theirs_in_words(),
                    head =
                        widgets::wrapped(ui.theme.strong, "Another program has saved this case's plan", room),
                    differs = words.empty() ? "" : widgets::wrapped(ui.theme.body, "Theirs: " + words, room);
  draw.PushClipRect(area.min(), area.max(), true);
  draw.AddText(ui.theme.strong, font, {left, top}, widgets::kText, head.c_str());
  const float below = top + ui.theme.strong->CalcTextSizeA(font, 1e9F, 0, head.c_str()).y;
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {left, below}, widgets::kText, differs.c_str());
  draw.PopClipRect();
  ImGui::SetCursorScreenPos({area.x + area.width - 2 * width - ui.theme.px(20), middle - height / 2});
  widgets::action_button(ui, "plan.take_theirs", width, height);
  ImGui::SetCursorScreenPos({area.x + area.width - width - ui.theme.px(10), middle - height / 2});
  widgets::action_button(ui, "plan.keep_ours", width, height);
}

void PlanView::draw_hint(const widgets::Ui& ui, const widgets::Rect& area,
                         const std::vector<ImVec2>& handles) const {
  const std::string bone(bones::to_text(state_.key.bone));
  const Hint& hint = state_.hint;
  std::string text = hint.text;
  if (text.empty() && state_.placing == Placing::Entry)
    text = "Click on the " + bone + ": the tunnel begins there. Esc leaves it.";
  if (text.empty() && state_.placing == Placing::Landmark)
    text = "Click on the " + bone + " where the landmark is. Esc leaves it.";
  if (text.empty() && defaults_.is_running())
    text = "Making the default plan: " + defaults_.progress() + ". Esc leaves it.";
  if (text.empty() && export_.is_running())
    text = export_.is_stopping() ? "Stopping the export ..."
                                 : "Exporting: the bones are drilled, which takes a while. Esc stops it.";
  if (text.empty()) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* font = hint.of ? ui.theme.body : text.size() > 90 ? ui.theme.strong : ui.theme.title;
  const float wrap = area.width - ui.theme.px(40), pad = ui.theme.px(6);
  // What came of something stands there until somebody has read it, and hides the bone: a third of the
  // picture at the most. What is longer is scrolled.
  const float way_out = hint.is_news || hint.of ? ui.theme.body->FontSize : 0,
              room = std::max(area.height / 3 - way_out, 2 * font->FontSize);
  const auto size_of = [&](const std::string& lines) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, lines.c_str());
  };
  std::string lines = widgets::wrapped(font, text, wrap);
  ImVec2 size = size_of(lines);
  const bool is_long = size.y > room;
  if (is_long) {
    const float bar = ImGui::GetStyle().ScrollbarSize + pad;
    lines = widgets::wrapped(font, text, wrap - bar);
    size = {wrap, std::floor(room / font->FontSize) * font->FontSize};
  }
  const char* const way_out_words =
      is_long ? "Esc takes this away, the wheel shows the rest" : "Esc takes this away";
  if (way_out > 0) size.x = std::max(size.x, ui.theme.body->CalcTextSizeA(way_out, 1e9F, 0, way_out_words).x);
  // Clear of the words at the picture's upper and lower edges, which say where these are.
  const float edge = ui.theme.px(20) + ui.theme.body->FontSize - pad;
  const widgets::Rect upper{area.x + ui.theme.px(20) - pad, area.y + edge, size.x + 2 * pad,
                            size.y + way_out + 2 * pad};
  widgets::Rect lower = upper;
  lower.y = area.y + area.height - edge - lower.height;
  const widgets::Rect box = clear_place(upper, lower, handles);
  const ImVec2 at{box.x + pad, box.y + pad};
  // Read over a bright bone or a brighter MR, too.
  draw.AddRectFilled(box.min(), box.max(), IM_COL32(12, 16, 20, 210), pad);
  if (way_out > 0)
    draw.AddText(ui.theme.body, way_out, {at.x, at.y + size.y}, widgets::kQuietText, way_out_words);
  const ImU32 color = hint.text.empty() ? widgets::kAccent
                      : hint.is_news    ? widgets::kText
                                        : widgets::kCaution;
  if (!is_long) {
    draw.AddText(font, font->FontSize, at, color, lines.c_str());
    return;
  }
  ImGui::SetCursorScreenPos(at);
  ImGui::PushID(text.c_str());  // another text begins at its beginning
  ImGui::BeginChild("hint", size, false, ImGuiWindowFlags_NoBackground);
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, ImGui::GetCursorScreenPos(), color,
                                      lines.c_str());
  ImGui::Dummy(size_of(lines));
  ImGui::EndChild();
  ImGui::PopID();
}

}  // namespace arthronaut::plan
