// Before a case is open, and whenever another is wanted: recent cases, the built-in knee, a browser of
// folders, the hospital's PACS, and the import from what the hospital gave. Everything by mouse and by key; a
// folder that is dropped on the window comes here.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/folders/folder_browser.h"
#include "app/start/case_list.h"
#include "app/start/import_work.h"
#include "app/start/made_bones.h"
#include "app/start/pacs_pane.h"
#include "app/start/planned_series.h"
#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"

namespace arthronaut::start {

// Images after the operation, and the case whose plan they are to be compared with.
struct AfterOperation {
  std::filesystem::path case_folder, source;
  std::string series;  // UID; empty: of one volume
};

class StartView {
 public:
  // open: opens a case; an empty path is the built-in knee.
  StartView(std::function<void(const std::filesystem::path&)> open, std::function<void()> wake,
            std::function<void()> make_current);

  void add_actions(widgets::Actions& actions);  // all start with "start."
  // Comes to the front, on the list of cases. open_case: the folder of the one that one can go back to;
  // empty: none is open.
  void enter(const std::filesystem::path& open_case);
  void leave();  // something else comes to the front
  [[nodiscard]] bool shows_cases() const { return state_.page == Page::Cases; }
  void open_built_in() { open_({}); }
  // A folder or file from outside: a case is opened, 3D Slicer's markups are for the case that is open
  // (take_markups()), anything else is looked into for the import.
  void take(const std::filesystem::path& path);
  // The folders of this machine, in which one of these is to be chosen; title: what is asked for, where it is
  // not any of them.
  void browse(std::string title = "Open a case, or import images or meshes");
  // Once what was chosen of markups, after which it wants to close.
  [[nodiscard]] std::optional<std::filesystem::path> take_markups() {
    return std::exchange(markups_, std::nullopt);
  }
  // Once what was chosen of images after the operation.
  [[nodiscard]] std::optional<AfterOperation> take_after_operation() {
    return std::exchange(after_operation_, std::nullopt);
  }
  void tick();
  void draw(const widgets::Ui& ui, const widgets::Rect& area);

  // Something will change without anybody's doing.
  [[nodiscard]] bool is_busy() const {
    return work_.is_busy() || work_.makes_pictures() || planned_.is_busy() ||
           (state_.page == Page::Cases && cases_.is_busy()) || pacs_.is_busy();
  }
  // An import or a transfer runs that the end of the program would cut off.
  [[nodiscard]] bool has_running_work() const;
  // What is typed next is meant for a text field.
  [[nodiscard]] bool awaits_text() const {
    return (state_.page == Page::Cases && cases_.awaits_text()) ||
           (state_.page == Page::Pacs && pacs_.awaits_text()) ||
           (state_.page == Page::Browse && browser_.awaits_text());
  }
  [[nodiscard]] bool wants_to_close() const { return wants_to_close_; }

 private:
  enum class Page { Cases, Browse, Import, Pacs };
  void add_page_actions(widgets::Actions& actions);
  void add_import_actions(widgets::Actions& actions);
  void add_question_actions(widgets::Actions& actions);
  void move_selection(int by);
  void go_back();
  void accept();  // Enter
  void accept_entry();
  void start_import(bool images_only = false);
  void save_import();
  [[nodiscard]] bool has_sure_side() const;
  [[nodiscard]] std::size_t row_count() const;
  [[nodiscard]] bool imports() const;
  // Whose operation the selected images may be after; null: nobody's that is known.
  [[nodiscard]] const library::PlannedCase* planned_of_selected() const;
  [[nodiscard]] importing::FailureReason question() const;
  [[nodiscard]] bool asks(importing::FailureReason reason) const;
  [[nodiscard]] bool asks_for_labels() const;
  [[nodiscard]] bool selects_mesh() const;
  void tick_selected();
  // Of volumes one alone is taken: the one that somebody went to.
  void take_selected_volume();
  void say_bone(bones::BoneKind kind);

  void draw_browser(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_import(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_sources(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_answers(const widgets::Ui& ui, const widgets::Rect& bar);
  void draw_refusal(const widgets::Ui& ui);
  void say_side(bones::Side side);
  void draw_result(const widgets::Ui& ui, const widgets::Rect& area);
  // A row of this page's list; true when it was chosen by a click twice.
  bool draw_page_row(const widgets::Ui& ui, const std::string& name, std::size_t row, float height);

  struct ViewState {
    Page page = Page::Cases;
    std::size_t selected = 0;
    bool scrolls_to_selected = false;
    std::filesystem::path open_case;
    std::string browse_title;
    std::vector<std::size_t> ticked;  // of the sources
    std::optional<bones::Side> side;
    bool side_was_said = false;             // by a person
    std::map<bones::BoneKind, int> labels;  // of the map that is asked about
    std::optional<bones::LengthUnit> unit;  // of meshes that need one
    std::string name;                       // of the new case
  };

  std::function<void(const std::filesystem::path&)> open_;
  ImportWork work_;
  PlannedSeries planned_;
  MadeBones made_;
  CaseList cases_;
  PacsPane pacs_;
  folders::FolderBrowser browser_{"start.entry"};
  ViewState state_;
  std::map<std::size_t, std::unique_ptr<widgets::GreyTexture>> thumbnails_;  // by source
  bool wants_to_close_ = false;
  std::optional<std::filesystem::path> markups_;
  std::optional<AfterOperation> after_operation_;
};

}  // namespace arthronaut::start
