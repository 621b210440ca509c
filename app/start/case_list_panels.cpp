// How the list of cases looks.
#include <imgui.h>
#include <imgui_stdlib.h>

#include "app/start/case_list.h"
#include "app/widgets/list_rows.h"
#include "planning/files/format.h"
#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"
#include "planning/files/within_folder.h"

namespace arthronaut::start {

namespace {

using library::CaseRecord;
using library::CaseState;
using widgets::Severity;

using plan_review::TunnelVerdict;

// A tick says that every bone is planned and that nothing speaks against it; nobody has looked: no tick.
Severity severity_of_plan(const CaseRecord& record, const TunnelVerdict* verdict) {
  if (verdict == nullptr) return Severity::Quiet;
  if (!verdict->is_fine()) return Severity::Caution;  // without a plan: what speaks against the bones
  return record.is_planned_whole() ? Severity::Good : Severity::Quiet;  // nor for half a plan
}

// While it is found out, that is what is said.
std::string plan_words(const CaseRecord& record, const CasePictures& pictures) {
  const TunnelVerdict* const verdict = pictures.verdict_of(record.folder);
  if (verdict == nullptr && !record.planned.empty() && record.is_there && pictures.is_coming(record.folder))
    return record.plan_in_words() + "; being checked\u2026";
  return workstation_library::plan_in_words(record, verdict);
}

std::string doubts_in_words(const CaseRecord& record) {
  std::string words;
  if (record.last_session() != nullptr)
    for (const std::string& doubt : record.last_session()->doubts()) words += "; " + doubt;
  return words;
}

std::string capital(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 32);
  return words;
}

const char* why_no_picture(const CaseRecord& record, const CasePictures& pictures) {
  return record.is_there && record.problem.empty() && pictures.is_coming(record.folder) ? "Being drawn\u2026"
                                                                                        : "No picture";
}

// why_none: what stands in its place, as far as there is room.
void draw_picture(const widgets::Ui& ui, const widgets::VideoTexture* picture, const widgets::Rect& place,
                  const char* why_none) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(place.min(), place.max(), IM_COL32(14, 17, 21, 255));
  if (picture == nullptr || picture->texture() == 0) {
    ImFont* const font = ui.theme.body;
    const bool is_narrow = font->CalcTextSizeA(font->FontSize, 1e9F, 0, why_none).x > place.width;
    widgets::text_centered(ui, place, font, widgets::kQuietText, is_narrow ? "\u2026" : why_none);
    return;
  }
  const widgets::Rect into =
      widgets::fitted(place, static_cast<float>(picture->width()) / static_cast<float>(picture->height()));
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture->texture())), into.min(),
                into.max());
}

}  // namespace

Severity severity_of(const CaseRecord& record, const TunnelVerdict* verdict) {
  const bool is_doubted = verdict != nullptr && !verdict->is_fine();
  switch (record.state()) {
    case CaseState::Missing:
      return Severity::Caution;
    case CaseState::Unreadable:
      return Severity::Bad;
    case CaseState::NotPlanned:
    case CaseState::Planned:
      return severity_of_plan(record, verdict);
    case CaseState::Navigated:
    case CaseState::Drilled:
      break;
  }
  // A tick says that a tunnel was drilled and nothing of plan and last operation is in doubt, not that it
  // went as planned: its numbers stand beside it. What a CT alone shows is neither.
  const library::SessionFacts* const last = record.last_session();
  if (is_doubted) return Severity::Caution;
  if (last == nullptr || last->is_simulated()) return Severity::Quiet;
  if (last->is_in_doubt()) return Severity::Caution;
  return last->is_drilled() ? Severity::Good : Severity::Quiet;
}

std::string state_in_words(const CaseRecord& record, const TunnelVerdict* verdict) {
  const CaseState state = record.state();
  const std::string words = capital(std::string(to_text(state)));
  const std::string of_plan = workstation_library::in_words(verdict);
  if (state == CaseState::NotPlanned) return words + of_plan;
  const Severity severity = severity_of(record, verdict);
  if (severity == Severity::Caution || severity == Severity::Bad)
    return words + (record.is_simulated() ? ", simulated: " : ": ") + record.last_outcome() +
           doubts_in_words(record) + (of_plan.empty() ? "" : "; plan:" + of_plan.substr(1));
  const std::size_t count = record.sessions.size();
  if (count == 0) return words;
  return words + ", " + std::to_string(count) + (count == 1 ? " session" : " sessions, the last") +
         (record.last_session()->is_simulated() ? " simulated: " : ": ") + record.last_outcome();
}

void CaseList::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  ui.log.note_state("library", library_.is_looking() ? "looking" : "ready");
  ui.log.note_state("cases_listed", std::to_string(found_.size()));
  ui.log.note_state("library_says", library_.what());
  ui.log.note_state("order", to_text(view_.query.order));
  // Keys are letters while this is so.
  ui.log.note_state("typing", ImGui::GetIO().WantTextInput ? "yes" : "no");
  ui.log.note_state("page", view_.shows_trends ? "trends" : "list");
  const std::string none = lists_built_in() ? "built-in" : "none";
  ui.log.note_state("case_selected", selected() != nullptr ? selected()->name : none);
  ui.log.note_state("case_state", selected() != nullptr ? to_text(selected()->state()) : none);
  ui.log.note_state("note", selected() != nullptr ? selected()->note : "");
  if (view_.shows_trends) return draw_trends(ui, area);
  widgets::Rect rest = area;
  draw_head(ui, rest.cut_top(ui.theme.px(devices_.empty() ? 108 : 146)));
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {"start.accept", "start.browse", "start.pacs", "start.built_in", "start.tour",
                         "start.note", "start.trends", "start.forget", "start.back"});
  const widgets::Rect side = rest.cut_right(ui.theme.px(560), ui.theme.px(12));
  draw_list(ui, rest);
  draw_details(ui, side);
  view_.scrolls_to_selected = false;
}

void CaseList::draw_head(const widgets::Ui& ui, widgets::Rect head) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  widgets::draw_text(draw, ui.theme.title, head.x, head.y, widgets::kText, "Which knee?");
  const std::size_t all = library_.records().size();
  const std::string count = library_.is_looking() ? "Looking through the cases\u2026"
                            : found_.size() == all
                                ? std::to_string(all) + (all == 1 ? " case" : " cases")
                                : std::to_string(found_.size()) + " of " + std::to_string(all) + " cases";
  const std::string hint =
      library_.what().empty()
          ? count + ".  Drop the hospital's folder or a case on this window, or choose here."
          : library_.what();
  widgets::draw_text(draw, ui.theme.body, head.x + ui.theme.px(230), head.y + ui.theme.px(8),
                     library_.what().empty() ? widgets::kQuietText : widgets::kCaution,
                     widgets::fitting(ui.theme.body, hint, head.width - ui.theme.px(230)));
  const float y = head.y + ui.theme.px(52), height = ui.theme.px(48);
  const float field = ui.theme.px(560);
  ImGui::SetCursorScreenPos({head.x, y});
  ImGui::SetNextItemWidth(field);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.theme.px(14), (height - ui.theme.body->FontSize) / 2});
  if (view_.focus == Focus::Search) {
    ImGui::SetKeyboardFocusHere();
    view_.focus = Focus::None;
  }
  // What was sought before is selected: the next letters take its place.
  const bool is_typed =
      ImGui::InputTextWithHint("##search", "Search (F): name, note, side, 2026-01, drilled\u2026",
                               &view_.query.words, ImGuiInputTextFlags_AutoSelectAll);
  // Escape alone would bring back what was there before.
  const bool is_cleared = ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGuiKey_Escape);
  if (is_cleared) view_.query.words.clear();
  if (is_typed || is_cleared) {
    view_.has_chosen = false;
    filter();
  }
  ui.log.note("start.search_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::PopStyleVar();
  const float width = ui.theme.px(150);
  float x = head.x + field + ui.theme.px(16);
  const auto filter_button = [&](const char* id, const std::string& now) {
    ImGui::SetCursorScreenPos({x, y});
    widgets::action_button(ui, id, width, height);
    x += width + ui.theme.px(10);
    widgets::draw_text(draw, ui.theme.body, x, y + (height - ui.theme.body->FontSize) / 2, widgets::kText,
                       now);
    x += ui.theme.px(140);
  };
  filter_button("start.side", view_.query.side ? library::word_of(view_.query.side) : "both");
  filter_button("start.state", view_.query.state ? std::string(to_text(*view_.query.state)) : "any");
  filter_button("start.order", std::string(to_text(view_.query.order)));
  if (devices_.empty()) return;
  // Of the arthroscope that stands worst, at this moment: a window may be open over midnight. The others
  // stand among the trends.
  const library::AccuracyStanding standing = library::worst_standing(accuracy_, files::utc_now());
  ui.log.note_state("accuracy", standing.text);
  const widgets::Severity severity = standing.is_fine() ? widgets::Severity::Good
                                     : standing.outcome == library::AccuracyStanding::Outcome::MissingToday
                                         ? widgets::Severity::Caution
                                         : widgets::Severity::Bad;
  widgets::draw_text(
      draw, ui.theme.body, head.x, y + height + ui.theme.px(10), widgets::color_of(severity),
      widgets::fitting(ui.theme.body, std::string(standing.is_fine() ? "" : "! ") + standing.text,
                       head.width));
}

void CaseList::draw_list(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "start.cases", area);
  if (is_first_look()) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, "Looking through the cases\u2026");
    widgets::end_panel();
    return;
  }
  if (found_.empty() && !library_.records().empty())
    widgets::text_in(ui.theme.strong, widgets::kCaution,
                     view_.query.words.empty() ? "No case is like that: S and A show other ones."
                                               : "No case is like that: F, then Esc, clears the search.");
  const float height = ui.theme.px(96);
  const std::size_t row = selected_row();
  bool opens = false;
  // Of a thousand rows those in view are drawn.
  ImGuiListClipper clipper;
  const float step = height + ImGui::GetStyle().ItemSpacing.y;
  clipper.Begin(static_cast<int>(row_count()), step);
  if (view_.scrolls_to_selected)
    ImGui::SetScrollFromPosY(
        clipper.StartPosY - ImGui::GetWindowPos().y + step * (static_cast<float>(row) + 0.5F), 0.5F);
  while (clipper.Step()) {
    for (auto i = static_cast<std::size_t>(clipper.DisplayStart);
         i < static_cast<std::size_t>(clipper.DisplayEnd); ++i) {
      const bool is_built_in = i == found_.size();
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float width = ImGui::GetContentRegionAvail().x;
      const widgets::RowPress press = widgets::draw_row(ui, {.name = "start.case." + std::to_string(i),
                                                             .number = i,
                                                             .height = height,
                                                             .is_selected = i == row,
                                                             .scrolls_here = false});
      if (press != widgets::RowPress::None) {
        view_.selected = is_built_in ? std::filesystem::path() : library_.records()[found_[i]].folder;
        view_.has_chosen = true;
      }
      opens = opens || press == widgets::RowPress::Twice;
      if (!is_built_in) {
        draw_case(ui, at, width, library_.records()[found_[i]]);
        continue;
      }
      ImDrawList& draw = *ImGui::GetWindowDrawList();
      widgets::draw_text(draw, ui.theme.strong, at.x + ui.theme.px(132), at.y + ui.theme.px(18),
                         widgets::kText, "The built-in knee");
      widgets::draw_text(draw, ui.theme.body, at.x + ui.theme.px(132), at.y + ui.theme.px(48),
                         widgets::kQuietText,
                         widgets::fitting(ui.theme.body, "a right knee to learn on, planned and simulated",
                                          width - ui.theme.px(150)));
    }
  }
  widgets::end_panel();
  if (opens) accept();
}

std::string whose_and_where(const CaseRecord& record, const std::string& patient, bool is_found_by_patient) {
  const std::string whose = patient.empty()       ? ""
                            : is_found_by_patient ? "Found by its patient: " + patient
                                                  : patient;
  return whose + (whose.empty() ? "" : "  \u2013  ") +
         (record.note.empty() ? record.folder.string()
                              : "\u201C" + record.note.substr(0, record.note.find('\n')) + "\u201D");
}

void CaseList::draw_case(const widgets::Ui& ui, const ImVec2& at, float width, const CaseRecord& record) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float picture = ui.theme.px(105), x = at.x + picture + ui.theme.px(27);
  const widgets::Rect place{at.x + ui.theme.px(6), at.y + ui.theme.px(6), picture, ui.theme.px(84)};
  const bool has_picture = record.is_there && record.problem.empty();
  draw_picture(ui, has_picture ? pictures_.of(record.folder) : nullptr, place,
               why_no_picture(record, pictures_));
  const float right = ui.theme.px(170), wide = at.x + width - x - right;
  // A long name is cut, never the side: a wrong side is a wrong operation.
  ImFont* const font = ui.theme.strong;
  const std::string side = record.side ? "  \u2013  " + library::word_of(record.side) : "";
  const float side_wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, side.c_str()).x;
  widgets::draw_text(draw, font, x, at.y + ui.theme.px(6),
                     record.is_there ? widgets::kText : widgets::kQuietText,
                     widgets::fitting(font, record.name, wide - ui.theme.px(12) - side_wide) + side);
  widgets::draw_text(draw, ui.theme.body, at.x + width - right, at.y + ui.theme.px(6), widgets::kQuietText,
                     when_in_words(used_utc(record), files::utc_now()));
  const TunnelVerdict* const verdict = pictures_.verdict_of(record.folder);
  const Severity severity = severity_of(record, verdict);
  widgets::draw_sign(draw, {x + ui.theme.px(10), at.y + ui.theme.px(48)}, ui.theme.px(9), severity);
  const std::string what = record.state() == CaseState::Planned ? capital(plan_words(record, pictures_))
                                                                : state_in_words(record, verdict);
  widgets::draw_text(draw, ui.theme.body, x + ui.theme.px(28), at.y + ui.theme.px(35),
                     severity == Severity::Good || severity == Severity::Quiet ? widgets::kText
                                                                               : widgets::color_of(severity),
                     widgets::fitting(ui.theme.body, what, wide + right - ui.theme.px(40)));
  const auto whose = library_.identities().find(record.folder);
  const std::string third =
      whose_and_where(record, whose != library_.identities().end() ? whose->second.in_words() : "",
                      found_by_patient_.contains(record.folder));
  widgets::draw_text(draw, ui.theme.body, x, at.y + ui.theme.px(64), widgets::kQuietText,
                     widgets::fitting(ui.theme.body, third, wide + right - ui.theme.px(12)));
}

void CaseList::draw_details(const widgets::Ui& ui, const widgets::Rect& area) {
  const CaseRecord* record = is_first_look() ? nullptr : selected();
  const bool shows_built_in = !is_first_look() && lists_built_in();
  widgets::begin_panel(ui, "start.details", area,
                       record != nullptr ? record->name
                       : shows_built_in  ? "The built-in knee"
                                         : "");
  if (record == nullptr) {
    if (shows_built_in)
      widgets::text_in(
          ui.theme.body, widgets::kQuietText,
          "A right knee to learn on. What is changed in it stays; the simulated operation in F2 drills "
          "what was planned. Tour (F9) leads through planning on it, in some minutes.");
    widgets::end_panel();
    return;
  }
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const widgets::Rect place{at.x, at.y, width, ui.theme.px(200)};
  const bool has_picture = record->is_there && record->problem.empty();
  draw_picture(ui, has_picture ? pictures_.of(record->folder) : nullptr, place,
               why_no_picture(*record, pictures_));
  ImGui::Dummy({width, place.height});
  const TunnelVerdict* const verdict = pictures_.verdict_of(record->folder);
  const Severity severity = severity_of(*record, verdict);
  const bool is_of_plan = record->state() == CaseState::Planned || record->state() == CaseState::NotPlanned;
  if (!is_of_plan && !record->last_outcome().empty() &&
      (severity == Severity::Caution || severity == Severity::Bad))
    widgets::status_row(ui, severity, capital(std::string(to_text(record->state()))), record->last_outcome());
  if (!record->part_problem.empty())
    widgets::status_row(ui, Severity::Caution, "Not readable",
                        files::within_folder(record->folder, record->part_problem));
  if (record->side)
    widgets::status_row(ui, Severity::Quiet, "Side", library::word_of(record->side) + " knee");
  if (record->problem.empty())
    widgets::status_row(ui, severity_of_plan(*record, verdict), "Plan", plan_words(*record, pictures_));
  if (const library::SessionFacts* last = record->last_session()) {
    std::string words;
    for (const std::string& part : {files::local_day(last->started_utc), last->what(), last->outcome()})
      if (!part.empty()) words += (words.empty() ? "" : "; ") + part;
    for (const std::string& doubt : last->doubts()) words += "; " + doubt;
    widgets::status_row(ui,
                        !last->problem.empty() ? Severity::Bad
                        : last->is_in_doubt()  ? Severity::Caution
                                               : Severity::Quiet,
                        "Last session", words);
    const bool is_trusted = last->registration_is_reliable.value_or(false) && last->was_verified;
    if (last->predicted_error_mm)
      widgets::status_row(ui, is_trusted ? Severity::Good : Severity::Caution, "Registration",
                          files::format("predicted error %.2f mm, ", *last->predicted_error_mm) +
                              (!last->registration_is_reliable.value_or(false) ? "not reliable"
                               : last->was_verified                            ? "verified"
                                                                               : "not verified"));
  }
  for (const library::PostoperativeFacts& found : record->postoperative) {
    const std::string tunnel = tunnels::name_of(found.tunnel);
    widgets::status_row(ui, found.is_reliable ? Severity::Quiet : Severity::Caution, "After the operation",
                        found.entry_offset_mm
                            ? files::format("%s %.1f mm, %.1f\u00B0 from the plan", tunnel.c_str(),
                                            *found.entry_offset_mm, found.angle_deg.value_or(0))
                            : tunnel + ": no tunnel found");
  }
  const std::string made =
      record->created_utc.empty() ? "" : "made " + files::local_day(record->created_utc) + ", ";
  if (!record->changed_utc.empty())
    widgets::status_row(ui, Severity::Quiet, "Dates",
                        made + "changed " + files::local_day(record->changed_utc));
  widgets::status_row(ui, Severity::Quiet, "Folder", record->folder.string());
  if (record->is_there) draw_note(ui, *record);
  widgets::end_panel();
}

void CaseList::draw_note(const widgets::Ui& ui, const CaseRecord& record) {
  if (view_.note_of != record.folder) {
    view_.note_of = record.folder;
    view_.note = view_.note_before = record.note;
  }
  ImGui::Dummy({0, ui.theme.px(4)});
  const bool is_same = view_.note == view_.note_before;
  widgets::text_in(ui.theme.strong, is_same ? widgets::kQuietText : widgets::kAccent,
                   is_same ? "Note (N); no patient's name" : "Note: Ctrl+Enter keeps it, Esc does not");
  if (view_.focus == Focus::Note) {
    ImGui::SetKeyboardFocusHere();
    view_.focus = Focus::None;
  }
  // A field of each case's own: one that is being written in takes no other case's text, and gives it none.
  ImGui::PushID(record.folder.c_str());
  ImGui::InputTextMultiline("##note", &view_.note, {-1, ui.theme.px(150)});
  ImGui::PopID();
  ui.log.note("start.note_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const bool was_left = ImGui::IsItemDeactivated();
  if (ImGui::IsItemActive()) view_.has_chosen = true;
  // Not edited: what somebody else has written meanwhile is shown.
  if (!ImGui::IsItemActive() && !was_left && is_same && record.note != view_.note_before)
    view_.note = view_.note_before = record.note;
  if (was_left) keep_note();
}

}  // namespace arthronaut::start
