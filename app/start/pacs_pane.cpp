#include "app/start/pacs_pane.h"

#include <GLFW/glfw3.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <utility>

#include "planning/cases/identity.h"
#include "planning/files/running_process.h"
#include "planning/geometry/error.h"

namespace arthronaut::start {

namespace fs = std::filesystem;
using Kind = PacsJob::Kind;
using State = PacsNews::State;
using widgets::Severity;

namespace {

bool is_of_running_program(const std::string& process_id) {
  int number = 0;
  const char* const end = process_id.data() + process_id.size();
  return std::from_chars(process_id.data(), end, number).ptr == end && files::is_running(number);
}

}  // namespace

PacsPane::PacsPane(std::function<void(const fs::path&)> look_into, std::function<void()> wake)
    : data_folder_(pacs_peers_file().parent_path()),
      outgoing_folder_(data_folder_ / "outgoing" / std::to_string(::getpid())),
      look_into_(std::move(look_into)),
      work_(std::move(wake)) {}

void PacsPane::enter(const SendableCase& sendable, const fs::path& open_case) {
  if (work_.is_busy()) return;
  forget_outgoing();
  view_.sendable = sendable;
  std::error_code gone;  // the same by whatever way it was opened
  view_.is_another =
      !open_case.empty() && !sendable.folder.empty() && !fs::equivalent(open_case, sendable.folder, gone);
  offer_patient(open_case);
  view_.page = Page::Search;
  view_.failure.clear();
  try {  // said on the screen, and the file left as it is
    peers_ = load_pacs_peers(pacs_peers_file());
  } catch (const std::exception& error) {
    view_.failure = error.what();
  }
  view_.peer = std::min(view_.peer, peers_.empty() ? 0 : peers_.size() - 1);
  view_.scrolls_to_peer = true;
  if (peers_.size() == 1 && !lights_.contains(peers_.front().name)) echo();
}

void PacsPane::offer_patient(const fs::path& open_case) {
  if (view_.patient_id != view_.offered_id || !view_.patient_name.empty()) return;
  view_.offered_id.clear();
  for (const fs::path& folder : {view_.sendable.folder, open_case}) {
    if (folder.empty() || !view_.offered_id.empty()) continue;
    try {
      if (const auto patient = cases::load_identity(folder)) view_.offered_id = patient->patient_id;
    } catch (const std::runtime_error&) {  // the case itself says that it cannot be read
    }
  }
  view_.patient_id = view_.offered_id;
}

PacsPane::~PacsPane() {
  work_.end();
  forget_outgoing();
}

void PacsPane::leave() {
  if (!work_.is_busy()) forget_outgoing();
}

const PacsPeer* PacsPane::peer() const { return view_.peer < peers_.size() ? &peers_[view_.peer] : nullptr; }

bool PacsPane::has_running_work() const {
  const Kind kind = work_.news().kind;
  return work_.is_busy() && (kind == Kind::Fetch || kind == Kind::Send || kind == Kind::WriteResults);
}

void PacsPane::tick(bool is_shown) {
  if (work_.poll() && !work_.is_busy()) take(work_.news(), is_shown);
}

// What came to its end.
void PacsPane::take(const PacsNews& news, bool is_shown) {
  const PacsPeer* asked = peer();
  const bool is_good = news.state == State::Done || news.state == State::Unreliable;
  if (asked != nullptr && news.state != State::Stopped && news.kind != Kind::WriteResults &&
      (news.kind == Kind::Echo || is_good))
    lights_[asked->name] = {.severity = is_good ? Severity::Good : Severity::Bad,
                            .words = news.kind == Kind::Echo ? news.words : "answers"};
  // Nobody knows whether it still answers: what failed may be on this side.
  if (asked != nullptr && news.state == State::Failed && news.kind != Kind::Echo &&
      news.kind != Kind::WriteResults)
    lights_.erase(asked->name);
  if (news.kind == Kind::Find && is_good) {
    found_ = news.found;
    list_found();
  }
  if (news.kind == Kind::WriteResults && is_good) {
    view_.outgoing = news.files;
    view_.outgoing_doubts = news.words;
  }
  if (news.kind == Kind::Fetch && is_good && is_shown && view_.page == Page::Search)
    look_into_(fetched_folder(data_folder_, *rows_.at(view_.row).series));
}

void PacsPane::list_found() {
  rows_.clear();
  for (const auto& patient : found_.patients) {
    rows_.push_back({.patient = &patient});
    for (const auto& study : patient.studies) {
      rows_.push_back({.patient = &patient, .study = &study});
      for (const auto& series : study.series)
        rows_.push_back({.patient = &patient, .study = &study, .series = &series});
    }
  }
  // The one with the most images is what a case is made of, as a rule.
  view_.row = 0;
  int most = -2;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].series == nullptr || rows_[i].series->image_count <= most) continue;
    most = rows_[i].series->image_count;
    view_.row = i;
  }
  view_.scrolls_to_row = true;
}

// From series to series; the lines above them are passed over.
void PacsPane::move_selection(int by) {
  if (work_.is_busy() || view_.page != Page::Search) return;
  const auto count = static_cast<int>(rows_.size());
  const int step = by < 0 ? -1 : 1;
  int wanted = static_cast<int>(view_.row);
  for (int left = std::abs(by); left > 0; --left) {
    int next = wanted + step;
    while (next >= 0 && next < count && rows_[static_cast<std::size_t>(next)].series == nullptr) next += step;
    if (next < 0 || next >= count) break;
    wanted = next;
  }
  view_.row = static_cast<std::size_t>(wanted);
  view_.scrolls_to_row = true;
}

bool PacsPane::go_back() {
  if (work_.is_busy()) {
    work_.cancel();
    return true;
  }
  view_.failure.clear();
  if (view_.page == Page::Send) forget_outgoing();
  return std::exchange(view_.page, Page::Search) != Page::Search;
}

void PacsPane::choose_peer(std::size_t number) {
  view_.peer = number;
  view_.scrolls_to_peer = true;
  forget_found();
}

void PacsPane::forget_found() {
  found_ = {};
  rows_.clear();
  view_.row = 0;
}

// It names the patient; so does what a program that crashed has left. What another window is about to send
// stays.
void PacsPane::forget_outgoing() {
  std::error_code ignored;
  fs::remove_all(outgoing_folder_, ignored);
  for (const auto& left : fs::directory_iterator(outgoing_folder_.parent_path(), ignored))
    if (!is_of_running_program(left.path().filename().string())) fs::remove_all(left.path(), ignored);
  fs::remove(outgoing_folder_.parent_path(), ignored);  // which the last one empties
  view_.outgoing.clear();
  view_.outgoing_doubts.clear();
}

void PacsPane::echo() {
  if (peer() == nullptr) return;
  PacsJob job{.kind = Kind::Echo, .peer = *peer()};
  job.peer.connection.retries = 0;  // a light that is quick
  work_.start(std::move(job));
}

void PacsPane::find() {
  if (peer() == nullptr || work_.is_busy()) return;
  forget_found();
  work_.start({.kind = Kind::Find,
               .peer = *peer(),
               .keys = {.patient_id = view_.patient_id,
                        .patient_name = view_.patient_name,
                        .study_date = view_.date,
                        .modality = view_.modality}});
}

void PacsPane::fetch() {
  const Row& row = rows_.at(view_.row);
  work_.start({.kind = Kind::Fetch,
               .peer = *peer(),
               .request = {.series_uid = row.series->uid,
                           .study_uid = row.study->uid,
                           .folder = fetched_folder(data_folder_, *row.series)}});
}

void PacsPane::keep_peer() {
  std::vector<PacsPeer> peers = peers_;
  try {  // what is wrong with the form is said beside it
    PacsPeer made = peer_of(view_.form);
    const auto same = [](const std::string& name) {
      return [&name](const PacsPeer& other) { return other.name == name; };
    };
    auto at = std::find_if(peers.begin(), peers.end(), same(view_.edited));
    if (made.name != view_.edited && std::any_of(peers.begin(), peers.end(), same(made.name)))
      throw InvalidInput("there is a PACS of that name already");
    if (at == peers.end()) at = peers.insert(peers.end(), PacsPeer{});
    *at = std::move(made);
    const auto row = static_cast<std::size_t>(at - peers.begin());
    save_pacs_peers(pacs_peers_file(), peers);
    lights_.erase(view_.edited);
    lights_.erase(at->name);
    peers_ = std::move(peers);
    choose_peer(row);  // another, or of another address
    view_.page = Page::Search;
    view_.failure.clear();
    echo();
  } catch (const std::exception& error) {
    view_.failure = error.what();
  }
}

void PacsPane::remove_peer() {
  std::vector<PacsPeer> peers = peers_;
  peers.erase(peers.begin() + static_cast<std::ptrdiff_t>(view_.peer));
  try {  // as in keep_peer()
    save_pacs_peers(pacs_peers_file(), peers);
    peers_ = std::move(peers);
    choose_peer(0);
    view_.failure.clear();
  } catch (const std::exception& error) {
    view_.failure = error.what();
  }
}

void PacsPane::write_results() {
  view_.outgoing.clear();
  work_.start({.kind = Kind::WriteResults,
               .peer = *peer(),
               .case_folder = view_.sendable.folder,
               .results_folder = outgoing_folder_,
               .is_deidentified = view_.is_deidentified});
}

void PacsPane::add_actions(widgets::Actions& actions, const std::function<bool()>& is_shown) {
  const auto searches = [this, is_shown] {
    return is_shown() && view_.page == Page::Search && !work_.is_busy();
  };
  actions.add(
      {"start.pacs.fields",
       "Patient, date",
       "Writes what to look for: Tab goes from field to field, Enter searches, Esc gives the keys back",
       GLFW_KEY_F,
       0,
       false,
       [this, searches] { return searches() && peer() != nullptr; },
       {},
       [this] { view_.takes_focus = true; }});
  actions.add({"start.pacs.find",
               "Search",
               "Asks the PACS for the patient's studies and series",
               GLFW_KEY_S,
               0,
               false,
               [this, searches] { return searches() && peer() != nullptr; },
               {},
               [this] { find(); }});
  actions.add({"start.pacs.fetch",
               "Fetch it",
               "Fetches the selected series, or the rest of it, then shows it as something to import",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, searches] {
                 return searches() && peer() != nullptr && view_.row < rows_.size() &&
                        rows_[view_.row].series != nullptr;
               },
               {},
               [this] { fetch(); }});
  add_peer_actions(actions, searches);
  add_send_actions(actions, [this, is_shown] { return is_shown() && view_.page == Page::Send; });
  actions.add({"start.pacs.keep",
               "Keep it",
               "Writes the PACS into your settings, and asks whether it answers",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, is_shown] { return is_shown() && view_.page == Page::Peer; },
               {},
               [this] { keep_peer(); }});
}

void PacsPane::add_peer_actions(widgets::Actions& actions, const std::function<bool()>& searches) {
  const auto has_peer = [this, searches] { return searches() && peer() != nullptr; };
  actions.add({"start.pacs.echo",
               "Does it answer?",
               "Asks the PACS whether it is there and speaks to us (C-ECHO)",
               GLFW_KEY_E,
               0,
               false,
               has_peer,
               {},
               [this] { echo(); }});
  actions.add({"start.pacs.next",
               "Next",
               "Chooses another one",
               GLFW_KEY_P,
               0,
               false,
               [this, searches] { return searches() && peers_.size() > 1; },
               {},
               [this] {
                 choose_peer((view_.peer + 1) % peers_.size());
                 if (!lights_.contains(peer()->name)) echo();
               }});
  const auto edit = [this](bool is_new) {
    view_.edited = is_new ? "" : peer()->name;
    view_.form = is_new ? PacsPeerForm{} : form_of(*peer());
    view_.failure.clear();
    view_.takes_focus = true;
    view_.page = Page::Peer;
  };
  actions.add({"start.pacs.add",
               "Add a PACS",
               "Name, address and certificates of another one",
               GLFW_KEY_A,
               0,
               false,
               searches,
               {},
               [edit] { edit(true); }});
  actions.add({"start.pacs.change",
               "Change",
               "Name, address and certificates of this one",
               GLFW_KEY_C,
               0,
               false,
               has_peer,
               {},
               [edit] { edit(false); }});
  actions.add({"start.pacs.remove",
               "Remove",
               "Takes the PACS out of your settings; nothing that was fetched goes with it",
               GLFW_KEY_DELETE,
               0,
               false,
               has_peer,
               {},
               [this] { remove_peer(); },
               {"remove the PACS"}});
}

}  // namespace arthronaut::start
