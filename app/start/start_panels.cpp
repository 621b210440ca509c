// How the start looks.
#include <algorithm>
#include <array>
#include <cstring>

#include "app/start/start_view.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::start {

namespace {

using State = ImportWork::State;
using widgets::Severity;

void text(ImDrawList& draw, ImFont* font, float x, float y, ImU32 color, const std::string& words,
          float wrap = 0) {
  draw.AddText(font, font->FontSize, {x, y}, color, words.c_str(), nullptr, wrap);
}

// Cut off with an ellipsis where it is too long.
std::string fitting(ImFont* font, const std::string& words, float width) {
  const auto wide = [&](const std::string& t) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, t.c_str()).x;
  };
  if (wide(words) <= width) return words;
  std::string cut = words;
  while (!cut.empty() && wide(cut + "\u2026") > width) {
    do cut.pop_back();
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U);
    if (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0xC0U) cut.pop_back();
  }
  return cut + "\u2026";
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
  }
  return "";
}

void buttons(const widgets::Ui& ui, widgets::Rect bar, std::initializer_list<const char*> ids) {
  ImGui::SetCursorScreenPos(bar.min());
  for (const char* id : ids) {
    widgets::action_button(ui, id, 0, bar.height);
    ImGui::SameLine();
  }
}

}  // namespace

void StartView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  switch (state_.page) {
    case Page::Cases:
      draw_cases(ui, area);
      break;
    case Page::Browse:
      draw_browser(ui, area);
      break;
    case Page::Import:
      draw_import(ui, area);
      break;
  }
  state_.scrolls_to_selected = false;
  constexpr std::array<const char*, 7> kStates{"idle",   "looking", "choosing", "running",
                                               "asking", "saving",  "done"};
  constexpr std::array<const char*, 3> kPages{"cases", "browse", "import"};
  ui.log.note_state("start", kPages[static_cast<std::size_t>(state_.page)]);
  ui.log.note_state("import", kStates[static_cast<std::size_t>(work_.state())]);
  ui.log.note_state("import_failure", work_.failure());
  const auto& entries = state_.listing.entries;
  ui.log.note_state("selected", state_.page == Page::Browse && state_.selected < entries.size()
                                    ? entries[state_.selected].name
                                    : std::to_string(state_.selected));
}

bool StartView::draw_row(const widgets::Ui& ui, const std::string& name, std::size_t row, float height) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PushID(static_cast<int>(row));
  if (ImGui::InvisibleButton("row", {width, height})) state_.selected = row;
  const bool twice = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
  const bool hovered = ImGui::IsItemHovered();
  if (state_.scrolls_to_selected && row == state_.selected) ImGui::SetScrollHereY(0.5F);
  ImGui::PopID();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 to(at.x + width, at.y + height);
  if (row == state_.selected) {
    draw.AddRectFilled(at, to, IM_COL32(28, 74, 104, 255), ui.theme.px(6));
    draw.AddRect(at, to, widgets::kAccent, ui.theme.px(6), 0, ui.theme.px(2));
  } else if (hovered) {
    draw.AddRectFilled(at, to, IM_COL32(38, 47, 57, 255), ui.theme.px(6));
  }
  std::string word = name;  // the list of widgets is one of words
  std::replace(word.begin(), word.end(), ' ', '_');
  if (ImGui::IsRectVisible(at, to)) ui.log.note(word, at, to);
  ImGui::SetCursorScreenPos(at);
  ImGui::Dummy({width, height});
  if (twice) state_.selected = row;
  return twice;
}

void StartView::draw_cases(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const float side = std::max((area.width - ui.theme.px(1240)) / 2, 0.F);
  rest.cut_left(side);
  rest.cut_right(side);
  const widgets::Rect head = rest.cut_top(ui.theme.px(96));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  text(draw, ui.theme.title, head.x, head.y + ui.theme.px(8), widgets::kText, "Which knee?");
  text(draw, ui.theme.body, head.x, head.y + ui.theme.px(52), widgets::kQuietText,
       "Drop the hospital's folder or a case on this window, or choose here.");
  buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
          {"start.browse", "start.built_in", "start.accept", "start.back"});
  widgets::begin_panel(ui, "start.cases", rest);
  const std::string now = files::utc_now();
  const float height = ui.theme.px(70);
  bool opens = false;
  for (std::size_t i = 0; i <= state_.recent.size(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    opens = draw_row(ui, "start.case." + std::to_string(i), i, height) || opens;
    const bool is_built_in = i == state_.recent.size();
    std::error_code error;
    const bool is_there = is_built_in || is_case_folder(state_.recent[i].folder);
    const std::string name = is_built_in ? "The built-in knee" : state_.recent[i].name;
    const std::string what = is_built_in ? "a right knee to learn on, planned and simulated"
                                         : state_.recent[i].side + " knee  \u2013  " +
                                               state_.recent[i].folder.string() +
                                               (is_there ? "" : "  \u2013  is not there now");
    const float x = at.x + ui.theme.px(16), when_width = ui.theme.px(170);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    text(list, ui.theme.strong, x, at.y + ui.theme.px(8), is_there ? widgets::kText : widgets::kQuietText,
         name);
    text(list, ui.theme.body, x, at.y + ui.theme.px(36), is_there ? widgets::kQuietText : widgets::kCaution,
         fitting(ui.theme.body, what, width - when_width - ui.theme.px(30)));
    if (!is_built_in)
      text(list, ui.theme.body, at.x + width - when_width, at.y + ui.theme.px(8), widgets::kQuietText,
           when_in_words(state_.recent[i].opened_utc, now));
  }
  widgets::end_panel();
  if (opens) accept();
}

void StartView::draw_browser(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(88));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  text(draw, ui.theme.title, head.x, head.y, widgets::kText, "Open a case, or import images or meshes");
  text(draw, ui.theme.body, head.x, head.y + ui.theme.px(46), widgets::kAccent,
       fitting(ui.theme.body, state_.listing.folder.string(), head.width));
  buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
          {"start.accept", "start.up", "start.home", "start.import_folder", "start.back"});
  widgets::begin_panel(ui, "start.folder", rest);
  bool opens = false;
  const float height = ui.theme.px(44);
  for (std::size_t i = 0; i < state_.listing.entries.size(); ++i) {
    const FolderEntry& entry = state_.listing.entries[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    opens = draw_row(ui, "start.entry." + entry.name, i, height) || opens;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = at.y + (height - ui.theme.body->FontSize) / 2;
    const bool is_case = entry.kind == FolderEntry::Kind::Case;
    text(list, ui.theme.body, at.x + ui.theme.px(16), y, is_case ? widgets::kAccent : widgets::kQuietText,
         word_of(entry.kind));
    text(list, is_case ? ui.theme.strong : ui.theme.body, at.x + ui.theme.px(120), y, widgets::kText,
         fitting(ui.theme.body, entry.name, width - ui.theme.px(320)));
    text(list, ui.theme.body, at.x + width - ui.theme.px(170), y, widgets::kQuietText, entry.detail);
  }
  if (!state_.listing.failure.empty())
    widgets::status_row(ui, Severity::Bad, "This folder cannot be looked into", state_.listing.failure);
  if (state_.listing.other_files > 0)
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     std::to_string(state_.listing.other_files) +
                         " other files. Images without an ending are found by Import this folder.");
  widgets::end_panel();
  if (opens) accept_entry();
}

void StartView::draw_import(const widgets::Ui& ui, const widgets::Rect& area) {
  switch (work_.state()) {
    case State::Looking:
      widgets::text_centered(ui, area, ui.theme.title, widgets::kText,
                             "Looking through the folder: " +
                                 widgets::fixed(100 * work_.looked_fraction(), 0) + " %\nEsc stops.");
      return;
    case State::Running:
    case State::Saving: {
      const importing::ImportProgress& progress = work_.progress();
      const std::string stage = work_.state() == State::Saving ? "Writing the case"
                                : progress.stage.empty()       ? "Starting"
                                                               : progress.stage;
      widgets::Rect rest = area;
      const widgets::Rect words = rest.cut_top(area.height / 2);
      widgets::text_centered(ui, words, ui.theme.title, widgets::kText, stage);
      const float width = area.width / 2, height = ui.theme.px(24);
      const ImVec2 at(area.x + area.width / 4, area.y + area.height / 2 + ui.theme.px(20));
      ImDrawList& draw = *ImGui::GetWindowDrawList();
      draw.AddRectFilled(at, {at.x + width, at.y + height}, widgets::kPanelEdge, ui.theme.px(6));
      const auto done = static_cast<float>(std::clamp(progress.fraction, 0.0, 1.0));
      draw.AddRectFilled(at, {at.x + width * done, at.y + height}, widgets::kAccent, ui.theme.px(6));
      buttons(ui, {at.x, at.y + ui.theme.px(60), width, ui.theme.px(56)}, {"start.back"});
      return;
    }
    case State::Asking:
      return draw_result(ui, area);
    default:
      return draw_sources(ui, area);
  }
}

void StartView::draw_sources(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(88));
  const ImportSources& found = work_.sources();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  text(draw, ui.theme.title, head.x, head.y, widgets::kText,
       found.sources.empty() ? "Nothing to import was found"
                             : "What was found. Take one, then make the bones");
  text(draw, ui.theme.body, head.x, head.y + ui.theme.px(46), widgets::kAccent,
       fitting(ui.theme.body, found.root.string(), head.width));
  buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
          {"start.import", "start.tick", "start.right", "start.left", "start.side_unknown", "start.back"});
  widgets::begin_panel(ui, "start.sources", rest);
  if (!work_.failure().empty()) widgets::status_row(ui, Severity::Bad, "Refused", work_.failure());
  const float height = ui.theme.px(132), picture = ui.theme.px(116);
  for (std::size_t i = 0; i < found.sources.size(); ++i) {
    const ImportSource& source = found.sources[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (draw_row(ui, "start.source." + std::to_string(i), i, height)) ui.actions.run("start.tick");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (const images::Thumbnail* made = work_.thumbnail(i); made != nullptr && made->width > 0) {
      auto& texture = thumbnails_[i];
      if (texture == nullptr) {
        texture = std::make_unique<widgets::GreyTexture>();
        texture->upload(made->width, made->height, made->grey);
      }
      const widgets::Rect into =
          widgets::fitted({at.x + ui.theme.px(8), at.y + ui.theme.px(8), picture, picture},
                          static_cast<float>(made->width) / static_cast<float>(made->height));
      list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture->texture())),
                    into.min(), into.max());
    }
    const bool is_ticked = std::find(state_.ticked.begin(), state_.ticked.end(), i) != state_.ticked.end();
    const float x = at.x + picture + ui.theme.px(30), wrap = width - picture - ui.theme.px(50);
    const Severity sign = !source.can_be_imported()  ? Severity::Bad
                          : !source.warnings.empty() ? Severity::Caution
                          : is_ticked                ? Severity::Good
                                                     : Severity::Quiet;
    widgets::draw_sign(list, {x + ui.theme.px(10), at.y + ui.theme.px(24)}, ui.theme.px(9), sign);
    text(list, ui.theme.strong, x + ui.theme.px(30), at.y + ui.theme.px(10), widgets::kText,
         fitting(ui.theme.strong, source.title + (is_ticked ? "  \u2013  taken" : ""), wrap));
    text(list, ui.theme.body, x + ui.theme.px(30), at.y + ui.theme.px(38), widgets::kQuietText,
         source.detail);
    const std::string wrong = !source.can_be_imported() ? "Cannot be imported: " + source.refusal
                              : source.warnings.empty() ? std::string()
                                                        : source.warnings.front();
    if (!wrong.empty())
      text(list, ui.theme.body, x + ui.theme.px(30), at.y + ui.theme.px(66),
           source.can_be_imported() ? widgets::kCaution : widgets::kBad, wrong, wrap);
  }
  for (const std::string& left : found.left_out) widgets::status_row(ui, Severity::Quiet, "Left out", left);
  widgets::end_panel();
}

void StartView::draw_result(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(64));
  const std::vector<std::string> doubts = work_.doubts();
  text(*ImGui::GetWindowDrawList(), ui.theme.title, head.x, head.y, widgets::kText,
       !state_.side     ? "Which knee is it? Nothing says so"
       : doubts.empty() ? "The bones are made"
                        : "The bones are made, but look before you rely on them");
  buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
          {"start.save", "start.right", "start.left", "start.back"});
  widgets::begin_panel(ui, "start.result", rest);
  widgets::text_in(ui.theme.strong, widgets::kQuietText,
                   "Name of the case (no patient's name: it stands in exports)");
  std::array<char, 128> name{};
  std::strncpy(name.data(), state_.name.c_str(), name.size() - 1);
  ImGui::SetNextItemWidth(ui.theme.px(520));
  if (ImGui::InputText("##name", name.data(), name.size())) state_.name = name.data();
  ui.log.note("start.name", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::Dummy({0, ui.theme.px(6)});
  if (!work_.failure().empty()) widgets::status_row(ui, Severity::Bad, "Not written", work_.failure());
  if (!state_.side)
    widgets::status_row(ui, Severity::Caution, "Side", "neither names nor images tell: press R or L");
  else
    widgets::status_row(
        ui, work_.result().side_was_guessed ? Severity::Caution : Severity::Good, "Side",
        std::string(bones::to_text(*state_.side)) +
            (work_.result().side_was_guessed ? ", by the name of the source: is that so?" : ""));
  for (const std::string& doubt : doubts) widgets::status_row(ui, Severity::Caution, "Look", doubt);
  for (const std::string& line : work_.result().lines) widgets::status_row(ui, Severity::Quiet, "", line);
  for (const importing::ImportedBone& bone : work_.result().bones)
    for (const std::string& line : bone.lines)
      widgets::status_row(ui, Severity::Quiet, bone.bone.kind == bones::BoneKind::Femur ? "Femur" : "Tibia",
                          line);
  widgets::end_panel();
}

}  // namespace arthronaut::start
