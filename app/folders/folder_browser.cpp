#include "app/folders/folder_browser.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>

#include "app/folders/typed_path.h"
#include "app/widgets/list_rows.h"
#include "planning/library/folder_search.h"

namespace arthronaut::folders {

namespace {

namespace fs = std::filesystem;

fs::path home_folder() {
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) : fs::path("/");
}

const char* word_of(FolderEntry::Kind kind) {
  switch (kind) {
    case FolderEntry::Kind::Case:
      return "case";
    case FolderEntry::Kind::Folder:
      return "folder";
    case FolderEntry::Kind::Image:
      return "images";
    case FolderEntry::Kind::Mesh:
      return "mesh";
    case FolderEntry::Kind::Markups:
      return "markups";
  }
  return "";
}

}  // namespace

void FolderBrowser::enter() { look_into(listing_.folder.empty() ? home_folder() : listing_.folder); }

void FolderBrowser::home() { look_into(home_folder()); }

void FolderBrowser::up() { look_into(listing_.folder.parent_path()); }

void FolderBrowser::type_path() {
  const std::string here = listing_.folder.string();
  typing_ = {
      .is_open = true, .takes_focus = true, .text = here.ends_with('/') ? here : here + "/", .problem = ""};
}

std::optional<fs::path> FolderBrowser::go_to(const std::string& text) {
  TypedPath typed = typed_path(text, listing_.folder);
  typing_.problem = typed.problem;
  if (!typed.problem.empty()) return std::nullopt;
  typing_ = {};
  std::error_code unknown;
  if (!fs::is_directory(typed.path, unknown) || library::is_case_folder(typed.path)) return typed.path;
  look_into(typed.path.has_filename() ? typed.path : typed.path.parent_path());
  return std::nullopt;
}

void FolderBrowser::look_into(const fs::path& folder) {
  typing_ = {};
  const fs::path from = listing_.folder;
  listing_ = list_folder(folder);
  selected_ = 0;
  for (std::size_t i = 0; i < listing_.entries.size(); ++i)
    if (listing_.entries[i].path == from) selected_ = i;
  scrolls_to_selected_ = true;
}

void FolderBrowser::move_selection(int by) {
  const auto count = static_cast<long>(listing_.entries.size());
  if (count == 0) return;
  selected_ = static_cast<std::size_t>(std::clamp(static_cast<long>(selected_) + by, 0L, count - 1));
  scrolls_to_selected_ = true;
}

std::optional<fs::path> FolderBrowser::open_selected() {
  if (!has_rows()) return std::nullopt;
  const FolderEntry entry = listing_.entries[selected_];
  if (entry.kind != FolderEntry::Kind::Folder) return entry.path;
  look_into(entry.path);
  return std::nullopt;
}

std::string FolderBrowser::selected() const { return has_rows() ? listing_.entries[selected_].name : ""; }

std::optional<fs::path> FolderBrowser::draw_typing(const widgets::Ui& ui, const widgets::Rect& line) {
  const auto complete = [](ImGuiInputTextCallbackData* data) {
    const auto& from = *static_cast<const fs::path*>(data->UserData);
    const std::string completed =
        completed_path({data->Buf, static_cast<std::size_t>(data->BufTextLen)}, from);
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, completed.c_str());
    return 0;
  };
  ImGui::SetCursorScreenPos(line.min());
  ImGui::SetNextItemWidth(line.width);
  if (typing_.takes_focus) ImGui::SetKeyboardFocusHere();
  typing_.takes_focus = false;
  // A path that is typed or pasted takes the place of the folder that stands there; one that was not there is
  // mended.
  const bool is_entered =
      ImGui::InputText("##path", &typing_.text,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                           (typing_.problem.empty() ? ImGuiInputTextFlags_AutoSelectAll : 0),
                       complete, &listing_.folder);
  ui.log.note(name_ + "_path", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  typing_.takes_letters = ImGui::IsItemActive();
  if (is_entered) {
    auto found = go_to(typing_.text);
    if (typing_.is_open) ImGui::SetKeyboardFocusHere(-1);  // what is not there is typed on
    return found;
  }
  if (ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) typing_ = {};
  return std::nullopt;
}

std::optional<fs::path> FolderBrowser::draw(const widgets::Ui& ui, widgets::Rect area,
                                            const std::string& title, const std::string& take_folder) {
  const widgets::Rect head = area.cut_top(ui.theme.px(88));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  widgets::draw_text(draw, ui.theme.title, head.x, head.y, widgets::kText, title);
  std::optional<fs::path> typed;
  if (typing_.is_open)
    typed = draw_typing(ui, {head.x, head.y + ui.theme.px(40), head.width, ui.theme.px(40)});
  else
    widgets::draw_text(draw, ui.theme.body, head.x, head.y + ui.theme.px(46), widgets::kAccent,
                       widgets::fitting(ui.theme.body, listing_.folder.string(), head.width));
  widgets::begin_panel(ui, name_.c_str(), area);
  bool opens = false;
  const float height = ui.theme.px(44);
  for (std::size_t i = 0; i < listing_.entries.size(); ++i) {
    const FolderEntry& entry = listing_.entries[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const widgets::RowPress press = widgets::draw_row(ui, {.name = name_ + "." + entry.name,
                                                           .number = i,
                                                           .height = height,
                                                           .is_selected = i == selected_,
                                                           .scrolls_here = scrolls_to_selected_});
    if (press != widgets::RowPress::None) selected_ = i;
    opens = opens || press == widgets::RowPress::Twice;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = at.y + (height - ui.theme.body->FontSize) / 2;
    const bool is_case = entry.kind == FolderEntry::Kind::Case;
    widgets::draw_text(list, ui.theme.body, at.x + ui.theme.px(16), y,
                       is_case ? widgets::kAccent : widgets::kQuietText, word_of(entry.kind));
    widgets::draw_text(list, is_case ? ui.theme.strong : ui.theme.body, at.x + ui.theme.px(120), y,
                       widgets::kText, widgets::fitting(ui.theme.body, entry.name, width - ui.theme.px(320)));
    widgets::draw_text(list, ui.theme.body, at.x + width - ui.theme.px(170), y, widgets::kQuietText,
                       entry.detail);
  }
  scrolls_to_selected_ = false;
  if (!typing_.problem.empty())
    widgets::status_row(ui, widgets::Severity::Caution, "Not there", typing_.problem);
  if (!listing_.failure.empty())
    widgets::status_row(ui, widgets::Severity::Bad, "This folder cannot be looked into", listing_.failure);
  if (listing_.other_files > 0)
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     std::to_string(listing_.other_files) +
                         (listing_.other_files == 1 ? " other file" : " other files") +
                         ". Images without an ending are found by " + take_folder + ".");
  if (listing_.failure.empty() && listing_.entries.empty() && listing_.other_files == 0)
    widgets::text_in(
        ui.theme.body, widgets::kQuietText,
        "This folder is empty, or all that is in it is hidden. Backspace goes to the one above.");
  widgets::end_panel();
  ui.log.note_state("selected", selected());
  ui.log.note_state("typed_path", typing_.is_open ? typing_.text : "");
  ui.log.note_state("typed_problem", typing_.takes_letters ? typing_.problem : "");
  if (typed) return typed;
  return opens ? open_selected() : std::nullopt;
}

}  // namespace arthronaut::folders
