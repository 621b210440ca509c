// How the PACS looks.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>

#include "app/start/pacs_pane.h"
#include "app/widgets/list_rows.h"
#include "planning/cases/identity.h"
#include "planning/files/format.h"

namespace arthronaut::start {

namespace {

using Kind = PacsJob::Kind;
using State = PacsNews::State;
using widgets::draw_text;
using widgets::fitting;
using widgets::Severity;

std::string counted(int count, const char* one, const char* many) {
  return count < 0 ? "? " + std::string(many) : std::to_string(count) + " " + (count == 1 ? one : many);
}

const char* word_of(Kind kind) {
  constexpr std::array<const char*, 5> kWords{"Asking whether it answers", "Searching", "Fetching",
                                              "Writing what goes out", "Sending"};
  return kWords[static_cast<std::size_t>(kind)];
}

// What an Esc leaves behind.
const char* word_of_stopping(Kind kind) {
  if (kind == Kind::Fetch) return "; what came whole is kept";
  return kind == Kind::Send ? "; what is stored there stays there" : "";
}

}  // namespace

Severity severity_of(State state) {
  if (state == State::Done) return Severity::Good;
  if (state == State::Failed) return Severity::Bad;
  return state == State::Unreliable || state == State::Stopped ? Severity::Caution : Severity::Quiet;
}

void PacsPane::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  note_states(ui);
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(60));
  const char* title = view_.page == Page::Search ? "Images from the hospital's PACS"
                      : view_.page == Page::Send ? "Results to the hospital's PACS"
                      : view_.edited.empty()     ? "Another PACS"
                                                 : "This PACS";
  draw_text(*ImGui::GetWindowDrawList(), ui.theme.title, head.x, head.y, widgets::kText, title);
  if (view_.page == Page::Peer) return draw_form(ui, rest);
  if (view_.page == Page::Send) return draw_send(ui, rest);
  draw_search(ui, rest);
}

void PacsPane::note_states(const widgets::Ui& ui) const {
  constexpr std::array<const char*, 3> kPages{"search", "peer", "send"};
  constexpr std::array<const char*, 6> kStates{"idle", "running", "done", "unreliable", "failed", "stopped"};
  constexpr std::array<const char*, 5> kKinds{"echo", "find", "fetch", "write", "send"};
  const PacsNews& news = work_.news();
  ui.log.note_state("pacs", kPages[static_cast<std::size_t>(view_.page)]);
  ui.log.note_state("pacs_peer", peer() != nullptr ? peer()->name : "none");
  const auto light = peer() != nullptr ? lights_.find(peer()->name) : lights_.end();
  constexpr std::array<const char*, 4> kLights{"good", "caution", "bad", "quiet"};
  ui.log.note_state("pacs_light", light == lights_.end()
                                      ? "quiet"
                                      : kLights[static_cast<std::size_t>(light->second.severity)]);
  ui.log.note_state("pacs_work", news.state == State::Idle
                                     ? "idle"
                                     : std::string(kKinds[static_cast<std::size_t>(news.kind)]) + "-" +
                                           kStates[static_cast<std::size_t>(news.state)]);
  ui.log.note_state("pacs_says", news.words);
  ui.log.note_state("pacs_failure", view_.failure);
  ui.log.note_state("pacs_rows", std::to_string(rows_.size()));
  ui.log.note_state("pacs_done", std::to_string(news.progress.done));
  ui.log.note_state("pacs_outgoing", std::to_string(view_.outgoing.size()));
  ui.log.note_state("pacs_commitment", pacs::to_text(news.sent.commitment));
  ui.log.note_state("pacs_patient", view_.patient_id);
  ui.log.note_state("pacs_typing", ImGui::GetIO().WantTextInput ? "yes" : "no");
}

void PacsPane::draw_search(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {"start.pacs.fetch", "start.pacs.find", "start.pacs.fields", "start.pacs.echo",
                         "start.pacs.results", "start.pacs.add", "start.back"});
  widgets::Rect left = rest.cut_left(ui.theme.px(520), ui.theme.px(12));
  const widgets::Rect fields = left.cut_bottom(ui.theme.px(280), ui.theme.px(12));
  draw_peers(ui, left);
  draw_fields(ui, fields);
  const bool has_news = work_.news().state != State::Idle && work_.news().kind != Kind::Echo;
  if (has_news || !view_.failure.empty()) draw_work(ui, rest.cut_top(ui.theme.px(130), ui.theme.px(12)));
  draw_found(ui, rest);
}

void PacsPane::draw_peers(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  // What is done with the selected one, and why it fails, stay in sight however long the list is.
  if (!peers_.empty())
    widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(48), ui.theme.px(8)),
                          {"start.pacs.next", "start.pacs.change", "start.pacs.remove"});
  const auto asked = peer() != nullptr ? lights_.find(peer()->name) : lights_.end();
  if (asked != lights_.end() && asked->second.severity == Severity::Bad) {
    widgets::begin_panel(ui, "start.pacs.peer_says", rest.cut_bottom(ui.theme.px(152), ui.theme.px(8)));
    widgets::status_row(ui, Severity::Bad, "No connection", asked->second.words);
    widgets::end_panel();
  }
  widgets::begin_panel(ui, "start.pacs.peers", rest, "Which PACS");
  if (peers_.empty())
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "None is known yet. Press A, and write what the hospital's IT tells you: its AE title, "
                     "host and port, and the title that it knows you by.");
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (widgets::draw_row(ui, {.name = "start.pacs.peer." + std::to_string(i),
                               .number = i,
                               .height = ui.theme.px(76),
                               .is_selected = i == view_.peer,
                               .scrolls_here = view_.scrolls_to_peer}) != widgets::RowPress::None &&
        !work_.is_busy() && i != view_.peer)
      choose_peer(i);
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(at);
    draw_peer_row(ui, i);
    ImGui::SetCursorScreenPos(after);
  }
  view_.scrolls_to_peer = false;
  widgets::end_panel();
}

// At ImGui's cursor: its name and whether it answers, and below it where it is, or what is wrong.
void PacsPane::draw_peer_row(const widgets::Ui& ui, std::size_t number) const {
  const PacsPeer& shown = peers_[number];
  const auto known = lights_.find(shown.name);
  const bool is_asked = work_.is_busy() && work_.news().kind == Kind::Echo && number == view_.peer;
  const Light light = is_asked                 ? Light{Severity::Quiet, "asking\u2026"}
                      : known == lights_.end() ? Light{}
                                               : known->second;
  const bool is_bad = light.severity == Severity::Bad;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float x = at.x + ui.theme.px(42), right = ui.theme.px(130);
  const float width = ImGui::GetContentRegionAvail().x - ui.theme.px(50);
  widgets::draw_sign(draw, {at.x + ui.theme.px(20), at.y + ui.theme.px(22)}, ui.theme.px(9), light.severity);
  draw_text(
      draw, ui.theme.strong, x, at.y + ui.theme.px(8), widgets::kText,
      fitting(ui.theme.strong, shown.name + (shown.connection.tls ? "  \u2013  TLS" : ""), width - right));
  if (!is_bad)
    draw_text(draw, ui.theme.body, x + width - right, at.y + ui.theme.px(8), widgets::kQuietText,
              light.severity == Severity::Good ? "answers" : light.words);
  // The address in front of the reason stands below the list.
  const std::string address = shown.address() + ": ";
  const std::string reason =
      light.words.starts_with(address) ? light.words.substr(address.size()) : light.words;
  draw_text(draw, ui.theme.body, x, at.y + ui.theme.px(40), is_bad ? widgets::kBad : widgets::kQuietText,
            fitting(ui.theme.body, is_bad ? reason : shown.address(), width));
}

bool PacsPane::field(const widgets::Ui& ui, const char* id, const std::string& name, std::string& text,
                     float width) {
  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.theme.px(10), ui.theme.px(8)});
  if (view_.takes_focus) ImGui::SetKeyboardFocusHere();
  view_.takes_focus = false;
  const bool is_entered = ImGui::InputTextWithHint(("##" + std::string(id)).c_str(), name.c_str(), &text,
                                                   ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note(id, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (ImGui::IsItemActive()) ui.log.note_state("pacs_field", id);
  ImGui::PopStyleVar();
  return is_entered;
}

void PacsPane::draw_fields(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "start.pacs.keys", area, "Who is looked for");
  const float width = ImGui::GetContentRegionAvail().x;
  // The first takes the keyboard when it is asked for; Tab goes on to the others.
  bool searches = field(ui, "start.pacs.id", "Patient ID", view_.patient_id, width);
  searches |= field(ui, "start.pacs.name", "Name: Muster^A*", view_.patient_name, width);
  searches |= field(ui, "start.pacs.date", "Date: 20260131, or 20260101-20260131", view_.date, width);
  searches |= field(ui, "start.pacs.modality", "Modality: CT, MR; empty: all", view_.modality, width);
  widgets::end_panel();
  if (searches) ui.actions.run("start.pacs.find");
}

void PacsPane::draw_work(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "start.pacs.work", area);
  const PacsNews& news = work_.news();
  if (!view_.failure.empty()) widgets::status_row(ui, Severity::Bad, "Your settings", view_.failure);
  if (news.state == State::Running) {
    const auto& progress = news.progress;
    std::string words = word_of(news.kind);
    if (progress.total > 0)
      words += files::format(": %d of %d, %.1f MB", progress.done, progress.total,
                             static_cast<double>(progress.bytes) / 1e6);
    if (!news.words.empty()) widgets::text_in(ui.theme.body, widgets::kCaution, news.words);
    widgets::text_in(
        ui.theme.strong, widgets::kText,
        words + (has_running_work() ? std::string(".  Esc stops") + word_of_stopping(news.kind) : "\u2026"));
    const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(20);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float done =
        progress.total > 0 ? static_cast<float>(progress.done) / static_cast<float>(progress.total) : 0.0F;
    draw.AddRectFilled(at, {at.x + width, at.y + height}, widgets::kPanelEdge, ui.theme.px(6));
    draw.AddRectFilled(at, {at.x + width * std::clamp(done, 0.0F, 1.0F), at.y + height}, widgets::kAccent,
                       ui.theme.px(6));
    ImGui::Dummy({width, height});
  } else if (news.state != State::Idle && news.kind != Kind::Echo) {
    const char* name = news.state == State::Failed    ? "It did not come about"
                       : news.state == State::Stopped ? "Stopped"
                       : news.kind == Kind::Find      ? "Found"
                                                      : "Done";
    widgets::status_row(ui, severity_of(news.state), name, news.words);
    const bool can_resume = news.kind == Kind::Fetch && news.state != State::Done;
    if (can_resume)
      widgets::text_in(ui.theme.body, widgets::kQuietText, "Enter on the series goes on where it was.");
  }
  widgets::end_panel();
}

void PacsPane::draw_found(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "start.pacs.found", area);
  if (rows_.empty() && !work_.is_busy() && !peers_.empty())  // else there is nobody to ask
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Press F and write a patient ID, a name or a date; Enter searches. * and ? stand for "
                     "anything.");
  bool fetches = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].series == nullptr) {
      draw_row_of(ui, rows_[i], i);
      continue;
    }
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const widgets::RowPress press = widgets::draw_row(ui, {.name = "start.pacs.series." + std::to_string(i),
                                                           .number = i,
                                                           .height = ui.theme.px(46),
                                                           .is_selected = i == view_.row,
                                                           .scrolls_here = view_.scrolls_to_row});
    if (press != widgets::RowPress::None && !work_.is_busy()) view_.row = i;
    fetches = fetches || press == widgets::RowPress::Twice;
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(at);
    draw_row_of(ui, rows_[i], i);
    ImGui::SetCursorScreenPos(after);
  }
  view_.scrolls_to_row = false;
  widgets::end_panel();
  if (fetches) ui.actions.run("start.pacs.fetch");
}

void PacsPane::draw_row_of(const widgets::Ui& ui, const Row& row, std::size_t /*number*/) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, right = ui.theme.px(150);
  if (row.series != nullptr) {
    const float y = at.y + (ui.theme.px(46) - ui.theme.body->FontSize) / 2;
    draw_text(draw, ui.theme.strong, at.x + ui.theme.px(40), y, widgets::kText,
              fitting(ui.theme.strong, row.series->modality, ui.theme.px(70)));
    draw_text(draw, ui.theme.body, at.x + ui.theme.px(120), y, widgets::kText,
              fitting(ui.theme.body,
                      "series " + row.series->number +
                          (row.series->description.empty() ? "" : "  \u2013  " + row.series->description),
                      width - ui.theme.px(140) - right));
    draw_text(draw, ui.theme.body, at.x + width - right, y, widgets::kQuietText,
              counted(row.series->image_count, "image", "images"));
    return;
  }
  const bool is_patient = row.study == nullptr;
  std::string words, counts;
  if (is_patient) {
    const cases::Identity whose{row.patient->name, row.patient->id, row.patient->birth_date};
    const std::string name = whose.name_in_words(), born = whose.birth_date_in_words();
    words = (name.empty() ? "no name" : name) +
            (whose.patient_id.empty() ? "  \u2013  no ID" : "  \u2013  ID " + whose.patient_id);
    if (!born.empty()) words += "  \u2013  born " + born;
    if (!row.patient->sex.empty()) words += "  \u2013  " + row.patient->sex;
    counts = counted(row.patient->study_count, "study", "studies");
  } else {
    words = cases::date_in_words(row.study->date);
    if (words.empty()) words = "undated";
    for (const std::string& modality : row.study->modalities) words += " " + modality;
    if (!row.study->description.empty()) words += "  \u2013  " + row.study->description;
    counts = counted(row.study->series_count, "series", "series");
  }
  const float height = ui.theme.px(is_patient ? 48 : 40);
  const float y = at.y + (height - ui.theme.body->FontSize) / 2;
  const float x = at.x + ui.theme.px(is_patient ? 8 : 24);
  draw_text(draw, is_patient ? ui.theme.strong : ui.theme.body, x, y,
            is_patient ? widgets::kAccent : widgets::kText,
            fitting(ui.theme.strong, words, width - right - ui.theme.px(40)));
  draw_text(draw, ui.theme.body, at.x + width - right, y, widgets::kQuietText, counts);
  ImGui::Dummy({width, height});
}

void PacsPane::draw_form(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {"start.pacs.keep", "start.back"});
  widgets::begin_panel(ui, "start.pacs.form", rest);
  if (!view_.failure.empty()) widgets::status_row(ui, Severity::Bad, "Not kept", view_.failure);
  const float width = std::min(ImGui::GetContentRegionAvail().x, ui.theme.px(760));
  PacsPeerForm& form = view_.form;
  bool keeps = false;
  const auto ask = [&](const char* id, const char* name, const char* hint, std::string& text) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, name);
    keeps |= field(ui, id, hint, text, width);
  };
  ask("start.pacs.form.name", "Its name, as you know it", "Clinic's archive", form.name);
  ask("start.pacs.form.address", "Its AE title, host and port; or the address of its DICOMweb",
      "PACS@pacs.hospital:104, https://pacs.hospital/dicom-web", form.address);
  ask("start.pacs.form.title", "Our own AE title, that it knows us by", "ARTHRONAUT", form.our_ae_title);
  ask("start.pacs.form.port", "Our port, where it calls us; empty: it never does", "11112",
      form.listening_port);
  ask("start.pacs.form.ca", "For TLS: certificate of the authority that signs its own; empty: no TLS",
      "/path/authority.pem", form.authority);
  ask("start.pacs.form.cert", "For TLS: our certificate", "/path/ours.pem", form.certificate);
  ask("start.pacs.form.key", "For TLS: our private key", "/path/ours.key", form.key);
  ask("start.pacs.form.password",
      "File with the password of the key, or of DICOMweb's user; empty: there is none", "/path/password",
      form.key_password_file);
  ask("start.pacs.form.user", "For DICOMweb: the user that it knows us by; empty: none", "theatre3",
      form.user);
  widgets::end_panel();
  if (keeps) keep_peer();
}

}  // namespace arthronaut::start
