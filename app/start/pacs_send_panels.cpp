// The results that go to the PACS: how they look, and what is done with them.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <set>

#include "app/start/pacs_pane.h"
#include "app/widgets/list_rows.h"
#include "planning/cases/identity.h"
#include "planning/files/format.h"

namespace arthronaut::start {

using Kind = PacsJob::Kind;
using State = PacsNews::State;
using widgets::Severity;

void PacsPane::draw_send(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {view_.outgoing.empty() ? "start.pacs.write" : "start.pacs.send",
                         "start.pacs.deidentified", "start.back"});
  const PacsNews& news = work_.news();
  const auto stored = std::count_if(news.sent.files.begin(), news.sent.files.end(),
                                    [](const pacs::SentFile& file) { return file.is_stored; });
  const bool are_all_stored = news.state == State::Done || news.state == State::Unreliable;
  const bool is_of_sending = news.kind == Kind::WriteResults || news.kind == Kind::Send;
  if (is_of_sending && news.state == State::Running)
    draw_work(ui, rest.cut_bottom(ui.theme.px(110), ui.theme.px(12)));
  widgets::begin_panel(ui, "start.pacs.outgoing", rest);
  ui.log.note_state("pacs_sends", view_.is_another ? "another case" : "the open case");
  if (view_.is_another)
    widgets::status_row(ui, Severity::Bad, "NOT the case that is open",
                        view_.sendable.name + ", which is selected in the list of cases");
  else
    widgets::status_row(ui, Severity::Quiet, "Case", view_.sendable.name);
  if (view_.sendable.plan && !view_.sendable.plan->is_fine())
    widgets::status_row(ui, view_.sendable.plan->is_wrong() ? Severity::Bad : Severity::Caution,
                        view_.sendable.plan->is_wrong() ? "Plan, wrong" : "Plan, look",
                        view_.sendable.plan->in_short());
  if (peer() != nullptr)
    widgets::status_row(ui, Severity::Quiet, "To",
                        peer()->name + ", " + peer()->address() +
                            (peer()->is_encrypted() ? ", by TLS" : ", not encrypted on the way"));
  if (news.kind == Kind::WriteResults && news.state == State::Failed)
    widgets::status_row(ui, Severity::Bad, "Not written", news.words);
  if (news.kind == Kind::Send && news.state != State::Running) {
    // Whether it commits itself to keep them is the next line's.
    widgets::status_row(ui, are_all_stored ? Severity::Good : severity_of(news.state),
                        are_all_stored ? "Sent"
                        : stored == 0  ? "Not sent"
                                       : "Not all sent",
                        news.words);
    const pacs::Commitment commitment = news.sent.commitment;
    if (commitment != pacs::Commitment::NotAsked || !news.sent.commitment_note.empty())
      widgets::status_row(ui,
                          commitment == pacs::Commitment::Confirmed ? Severity::Good
                          : commitment == pacs::Commitment::Failed  ? Severity::Bad
                                                                    : Severity::Caution,
                          std::string("Storage commitment ") + pacs::to_text(commitment),
                          news.sent.commitment_note);
  }
  draw_outgoing(ui);
  widgets::end_panel();
}

void PacsPane::draw_outgoing(const widgets::Ui& ui) {
  if (view_.outgoing.empty()) {
    widgets::status_row(ui, view_.is_deidentified ? Severity::Good : Severity::Caution, "Identity",
                        view_.is_deidentified ? "De-identified: it will name nobody"
                                              : "It will name the patient and be filed in his study");
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Nothing is sent yet. Enter writes what would go out and lists it here; D leaves the "
                     "patient out.");
    return;
  }
  // By what the objects themselves say.
  std::set<std::string> named;
  for (const pacs::SentFile& file : view_.outgoing)
    if (!file.patient_name.empty() || !file.patient_id.empty())
      named.insert(cases::Identity{file.patient_name, file.patient_id, file.birth_date}.in_words());
  std::string names;
  for (const std::string& name : named) names += (names.empty() ? "" : "; ") + name;
  if (view_.is_deidentified)
    widgets::status_row(ui, Severity::Good, "Identity",
                        "De-identified: filed as \"" + view_.outgoing.front().patient_name + "\", ID \"" +
                            view_.outgoing.front().patient_id + "\"");
  else if (named.empty())
    widgets::status_row(ui, Severity::Caution, "Identity",
                        "Names nobody: the case knows no patient, and a PACS may refuse it");
  else
    widgets::status_row(ui, named.size() == 1 ? Severity::Caution : Severity::Bad, "Identity",
                        "Names the patient: " + names);
  if (!view_.outgoing_doubts.empty())
    widgets::status_row(ui, Severity::Caution, "Look", view_.outgoing_doubts);
  const PacsNews& news = work_.news();
  for (const pacs::SentFile& written : view_.outgoing) {
    const pacs::SentFile* sent = nullptr;
    for (const pacs::SentFile& file : news.sent.files)
      if (file.sop_instance_uid == written.sop_instance_uid) sent = &file;
    std::error_code error;
    const auto size = std::filesystem::file_size(written.file, error);
    std::string words = written.file.filename().string();
    if (!error)
      words += size < 100000 ? files::format(", %.1f kB", static_cast<double>(size) / 1e3)
                             : files::format(", %.1f MB", static_cast<double>(size) / 1e6);
    if (sent != nullptr && sent->is_stored) words += sent->is_committed ? ": stored, kept" : ": stored";
    if (sent != nullptr && !sent->note.empty()) words += ": " + sent->note;
    const bool is_given_up = news.sent.commitment == pacs::Commitment::Failed;
    const Severity severity = sent == nullptr                            ? Severity::Quiet
                              : !sent->is_stored                         ? Severity::Bad
                              : is_given_up && !sent->is_committed       ? Severity::Bad
                              : sent->is_committed || sent->note.empty() ? Severity::Good
                                                                         : Severity::Caution;
    widgets::status_row(ui, severity, written.title, words);
  }
}

void PacsPane::add_send_actions(widgets::Actions& actions, const std::function<bool()>& sends) {
  actions.add({"start.pacs.results",
               "Send results",
               "Shows what of the case would go to the PACS, and whom it names, before anything is sent",
               GLFW_KEY_R,
               0,
               false,
               [this, actions = &actions] {
                 const widgets::Action* find = actions->find("start.pacs.find");
                 return find != nullptr && find->can_run() && !view_.sendable.folder.empty();
               },
               {},
               [this] { view_.page = Page::Send; }});
  const auto rests = [this, sends] { return sends() && !work_.is_busy(); };
  actions.add({"start.pacs.deidentified", "De-identified",
               "Leaves out patient, study, dates and pictures; what was written is written anew", GLFW_KEY_D,
               0, false, rests, [this] { return view_.is_deidentified; },
               [this] {
                 view_.is_deidentified = !view_.is_deidentified;
                 view_.outgoing.clear();
               }});
  actions.add({"start.pacs.write",
               "Show what goes out",
               "Writes bones, plan, report and pictures as DICOM on this machine, and lists them",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, rests] { return rests() && view_.outgoing.empty(); },
               {},
               [this] { write_results(); }});
  actions.add({"start.pacs.send",
               "Send",
               "Sends all that is listed, and asks the PACS to commit itself to keep it",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, rests] { return rests() && !view_.outgoing.empty(); },
               {},
               [this] { work_.start({.kind = Kind::Send, .peer = *peer(), .files = view_.outgoing}); },
               {"send"}});
}

}  // namespace arthronaut::start
