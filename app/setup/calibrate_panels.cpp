#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/setup/calibrate_station.h"
#include "app/setup/capture_panels.h"
#include "planning/files/format.h"
#include "planning/files/typed_number.h"

namespace arthronaut::setup {

using widgets::Severity;

void CalibrateStation::draw_pictures(const widgets::Ui& ui, const widgets::Rect& area) {
  if (run_ == nullptr)
    display_.band = {
        Severity::Quiet, "Nothing runs yet",
        "Show the board to the lens and turn the lens between the pictures; the camera head stays"};
  draw_form(ui, draw_capture(ui, area, picture_, status_.job, display_, ui.theme.px(250)));
}

void CalibrateStation::draw_form(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "setup.form", area, "Board and names");
  const float label = ui.theme.px(150);
  const auto field = [&](const char* name, const char* widget, const auto& edit) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({at.x, at.y + ui.theme.px(6)});
    widgets::text_in(ui.theme.body, widgets::kText, name);
    ImGui::SetCursorScreenPos({at.x + label, at.y});
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    edit();
    ui.log.note(widget, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImGui::SetCursorScreenPos({at.x, at.y + ui.theme.px(52)});
  };
  field("Square side", "setup.square", [&] {
    if (form_.wants_focus) ImGui::SetKeyboardFocusHere();
    form_.wants_focus = false;
    // Text, as ImGui's own field for numbers drops a comma: 1,5 became 15.
    std::string text = files::format("%.2f mm", form_.square_mm);
    if (ImGui::InputText("##square", &text, ImGuiInputTextFlags_AutoSelectAll))
      if (const auto side_mm = files::typed_number(text, "mm"); side_mm && *side_mm > 0 && *side_mm < 100)
        set_square(*side_mm);
  });
  field("Scope", "setup.scope", [&] { ImGui::InputText("##scope", &form_.scope_name); });
  field("Head", "setup.head", [&] { ImGui::InputText("##head", &form_.head_name); });
  widgets::end_panel();
}

void CalibrateStation::draw_result(const widgets::Ui& ui, const widgets::Rect& area) {
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  const widgets::Rect numbers = rest.cut_right(std::max(rest.width * 0.37F, ui.theme.px(420)), gap);
  const widgets::Rect verdict = rest.cut_bottom(ui.theme.px(130), gap);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(rest.min(), rest.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("setup.residuals", rest.min(), rest.max());
  const CalibrateStatus& job = status_.job;
  if (job.residuals != nullptr) {
    residuals_.upload(job.residuals);
    const widgets::Rect plot = widgets::fitted(
        rest, static_cast<float>(residuals_.width()) / static_cast<float>(residuals_.height()));
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(residuals_.texture())),
                  plot.min(), plot.max());
  } else {
    widgets::text_centered(ui, rest, ui.theme.title, widgets::kBad, "There is no result to show");
  }
  draw_band(ui, verdict, display_.verdict);
  std::vector<Row> against;
  for (const std::string& reason : display_.reasons) against.push_back({Severity::Bad, "Reason", reason});
  for (const std::string& note : display_.notes) against.push_back({Severity::Caution, "Note", note});
  widgets::Rect right = numbers;
  const widgets::Rect form = right.cut_bottom(ui.theme.px(230), gap);
  if (!against.empty())
    draw_rows(ui, "setup.reasons", right.cut_bottom(right.height * 0.38F, gap),
              display_.reasons.empty() ? "Worth knowing" : "Why refused", against);
  draw_rows(ui, "setup.result", right, "Result, \u00B1 one sigma", display_.result);
  draw_form(ui, form);
}

}  // namespace arthronaut::setup
