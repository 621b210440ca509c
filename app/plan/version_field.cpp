#include "app/plan/version_field.h"

#include <imgui.h>
#include <imgui_stdlib.h>

namespace arthronaut::plan {

std::optional<cases::VersionWords> VersionField::draw(const widgets::Ui& ui) {
  widgets::text_in(ui.theme.body, widgets::kAccent,
                   "Enter keeps name and note, Esc does not; no patient's name");
  if (takes_focus_) ImGui::SetKeyboardFocusHere();
  takes_focus_ = false;
  ImGui::SetNextItemWidth(-1);
  bool is_entered =
      ImGui::InputTextWithHint("##name", "Name", &words_.name, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note("plan.version_name", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const bool is_escape = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  bool is_left = ImGui::IsItemDeactivated() && is_escape;
  ImGui::SetNextItemWidth(-1);
  is_entered |=
      ImGui::InputTextWithHint("##note", "Note", &words_.note, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note("plan.version_note", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  is_left |= ImGui::IsItemDeactivated() && is_escape;
  if (is_left) close();
  return is_entered ? std::optional(words_) : std::nullopt;
}

}  // namespace arthronaut::plan
