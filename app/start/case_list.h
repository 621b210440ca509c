// The start's list of cases: all that the library knows, searched and filtered, the selected one in words
// with its picture and its note, and the trends over those that are listed.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "app/start/case_library.h"
#include "app/start/case_pictures.h"
#include "app/start/pacs_pane.h"
#include "app/start/recent_cases.h"
#include "app/widgets/controls.h"
#include "planning/library/accuracy_checks.h"
#include "planning/library/case_query.h"
#include "planning/library/trends.h"

namespace arthronaut::start {

// The third line of a case's row: whose knee it is, where that is known, and its note, else its folder.
// patient: cases::Identity::in_words().
[[nodiscard]] std::string whose_and_where(const library::CaseRecord& record, const std::string& patient,
                                          bool is_found_by_patient);

// The sign of a case's row, and what its second line says of it; of a plan alone the line is its own.
// verdict: of its plan, without one of its bones; null where nobody has looked.
[[nodiscard]] widgets::Severity severity_of(const library::CaseRecord& record,
                                            const plan_review::TunnelVerdict* verdict);
[[nodiscard]] std::string state_in_words(const library::CaseRecord& record,
                                         const plan_review::TunnelVerdict* verdict);

class CaseList {
 public:
  // open: opens a case; an empty path is the built-in knee, the last row of a list that nothing narrows.
  CaseList(std::function<void(const std::filesystem::path&)> open, std::function<void()> wake);

  // All start with "start."; is_shown: whether this page is in front.
  void add_actions(widgets::Actions& actions, const std::function<bool()>& is_shown);
  void enter();  // comes to the front: the folders are looked at again
  void leave();  // a note that is being written is kept, nothing is drawn off-screen any more
  void tick();
  void draw(const widgets::Ui& ui, const widgets::Rect& area);

  void move_selection(int by);
  void accept();                 // opens what is selected; where no case is like what is sought, nothing
  [[nodiscard]] bool go_back();  // out of the trends; false when they are not shown
  [[nodiscard]] std::size_t row_count() const { return found_.size() + (lists_built_in() ? 1 : 0); }
  // The selected case, where it is there and can be read.
  [[nodiscard]] SendableCase sendable() const;
  [[nodiscard]] bool shows_trends() const { return view_.shows_trends; }
  [[nodiscard]] bool is_busy() const { return library_.is_looking() || pictures_.is_busy(); }
  // A text field is to take the next letters.
  [[nodiscard]] bool awaits_text() const { return view_.focus != Focus::None; }

 private:
  enum class Focus { None, Search, Note };
  struct View {
    library::CaseQuery query;
    std::filesystem::path selected;  // its folder; empty: the built-in knee
    bool scrolls_to_selected = false, has_chosen = false;
    Focus focus = Focus::None;  // which field takes the keyboard with the next frame
    // The note that is shown or edited, the one it was made from, and whose it is.
    std::string note, note_before;
    std::filesystem::path note_of;
    bool shows_trends = false;
    // Of the sessions' trends, then of the daily checks of each device.
    std::size_t chart = 0;
    bool with_simulated = false;
    std::optional<bones::BoneKind> trend_bone;  // empty: both, told apart by their shapes
  };
  void filter();
  void keep_note();  // where it was changed
  void add_filter_actions(widgets::Actions& actions, const std::function<bool()>& is_shown);
  [[nodiscard]] const library::CaseRecord* selected() const;
  // When it was opened or changed last.
  [[nodiscard]] std::string used_utc(const library::CaseRecord& record) const;
  // A note that was changed and not yet kept.
  [[nodiscard]] bool is_writing() const {
    return view_.note_of == view_.selected && view_.note != view_.note_before;
  }
  // What is sought may be somebody's knee: the built-in one does not stand in for it.
  [[nodiscard]] bool lists_built_in() const;
  [[nodiscard]] std::size_t selected_row() const;  // found_.size(): the built-in knee, or nothing
  [[nodiscard]] bool is_first_look() const { return library_.is_looking() && library_.records().empty(); }

  void draw_head(const widgets::Ui& ui, widgets::Rect head);
  void draw_list(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_case(const widgets::Ui& ui, const ImVec2& at, float width, const library::CaseRecord& record);
  void draw_details(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_note(const widgets::Ui& ui, const library::CaseRecord& record);
  void draw_trends(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_chart_list(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] std::size_t chart_count() const;
  [[nodiscard]] std::string chart_name(std::size_t chart) const;

  std::function<void(const std::filesystem::path&)> open_;
  CaseLibrary library_;
  CasePictures pictures_;
  std::vector<RecentCase> recent_;
  std::vector<std::size_t> found_;  // of the library's records
  // Folders of those that are found only with what names their patient. Their rows say so: the list names
  // nobody, and that a name finds a case tells whose it is.
  std::set<std::filesystem::path> found_by_patient_;
  library::AccuracyChecks accuracy_;
  std::vector<library::AccuracyDevice> devices_;  // of these
  View view_;
};

}  // namespace arthronaut::start
