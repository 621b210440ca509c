// The hospital's PACS in the window: which ones there are and whether they answer, a patient's studies and
// series, a series fetched and handed to the import, and the results of a case sent. By keys alone where
// nothing is typed; what it asks for runs beside the screen (pacs_work.h).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/library/plan_verdict.h"
#include "app/start/pacs_work.h"
#include "app/widgets/controls.h"

namespace arthronaut::start {

// A case whose results may be sent; empty: none.
struct SendableCase {
  std::filesystem::path folder;
  std::string name;
  // What speaks against its plan, and what is to be looked at; empty where nobody has looked at it yet.
  std::optional<plan_review::TunnelVerdict> plan;
};

[[nodiscard]] widgets::Severity severity_of(PacsNews::State state);

class PacsPane {
 public:
  // look_into: hands a fetched folder to the import.
  PacsPane(std::function<void(const std::filesystem::path&)> look_into, std::function<void()> wake);

  ~PacsPane();  // stops what runs; what was written to be sent is gone with it
  PacsPane(const PacsPane&) = delete;
  PacsPane& operator=(const PacsPane&) = delete;

  // All start with "start.pacs."; is_shown: whether this page is in front.
  void add_actions(widgets::Actions& actions, const std::function<bool()>& is_shown);
  // Comes to the front; what runs goes on. open_case: empty where none is. The patient who is asked for is
  // the selected case's, else the open one's, unless somebody has typed another.
  void enter(const SendableCase& sendable, const std::filesystem::path& open_case);
  void leave();  // something else does; what was written to be sent goes, unless it is being sent
  void tick(bool is_shown);
  void draw(const widgets::Ui& ui, const widgets::Rect& area);

  void move_selection(int by);
  [[nodiscard]] bool
  go_back();  // out of a page, or stops what runs; false where there is nothing of the kind
  [[nodiscard]] bool is_busy() const { return work_.is_busy(); }
  // A transfer that the end of the program would break off.
  [[nodiscard]] bool has_running_work() const;
  [[nodiscard]] bool awaits_text() const { return view_.takes_focus; }

 private:
  enum class Page { Search, Peer, Send };
  // One line of what was found; only series can be chosen.
  struct Row {
    const pacs::FoundPatient* patient = nullptr;
    const pacs::FoundStudy* study = nullptr;
    const pacs::FoundSeries* series = nullptr;
  };
  struct Light {
    widgets::Severity severity = widgets::Severity::Quiet;
    std::string words = "not asked yet";
  };
  struct View {
    Page page = Page::Search;
    std::size_t peer = 0, row = 0;
    bool scrolls_to_row = false, scrolls_to_peer = false, takes_focus = false;
    std::string patient_id, patient_name, date, modality;
    std::string offered_id;  // that was put into the field
    PacsPeerForm form;
    std::string edited;  // the name of the peer that is changed; empty: a new one
    std::string failure;
    SendableCase sendable;
    bool is_another = false;  // than the case that is open
    bool is_deidentified = false;
    std::vector<pacs::SentFile> outgoing;  // written, and of the choice above
    std::string outgoing_doubts;
  };

  void add_peer_actions(widgets::Actions& actions, const std::function<bool()>& searches);
  void add_send_actions(widgets::Actions& actions, const std::function<bool()>& sends);
  [[nodiscard]] const PacsPeer* peer() const;
  void offer_patient(const std::filesystem::path& open_case);
  void choose_peer(std::size_t number);  // what was found is of one PACS
  void echo();
  void find();
  void fetch();
  void keep_peer();
  void remove_peer();
  void forget_found();
  void forget_outgoing();
  void write_results();
  void take(const PacsNews& news, bool is_shown);
  void list_found();

  void draw_search(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_peers(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_peer_row(const widgets::Ui& ui, std::size_t number) const;
  void draw_fields(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_found(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_row_of(const widgets::Ui& ui, const Row& row, std::size_t number);
  void draw_work(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_form(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_send(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_outgoing(const widgets::Ui& ui);
  void note_states(const widgets::Ui& ui) const;
  // A text field with its name; true when Enter was pressed in it.
  bool field(const widgets::Ui& ui, const char* id, const std::string& name, std::string& text, float width);

  const std::filesystem::path data_folder_;
  const std::filesystem::path outgoing_folder_;  // this process's own
  std::function<void(const std::filesystem::path&)> look_into_;
  PacsWork work_;
  std::vector<PacsPeer> peers_;
  std::map<std::string, Light> lights_;  // by the peer's name
  pacs::FindSummary found_;
  std::vector<Row> rows_;  // of found_
  View view_;
};

}  // namespace arthronaut::start
