#include "app/start/start_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"
#include "planning/library/folder_search.h"

namespace arthronaut::start {

namespace fs = std::filesystem;
using State = ImportWork::State;

StartView::StartView(std::function<void(const fs::path&)> open, std::function<void()> wake,
                     std::function<void()> make_current)
    : open_([this, open = std::move(open)](const fs::path& folder) {
        leave();
        open(folder);
      }),
      work_(wake),
      planned_(wake),
      made_(std::move(make_current), wake),
      cases_(open_, wake),
      pacs_([this](const fs::path& folder) { take(folder); }, wake) {}

void StartView::enter(const fs::path& open_case) {
  wants_to_close_ = false;
  markups_.reset();
  state_.open_case = open_case;
  cases_.enter();
  if (!work_.is_busy() && work_.state() != State::Asking) {
    state_.page = Page::Cases;
    state_.selected = 0;
  }
}

void StartView::leave() {
  cases_.leave();
  pacs_.leave();
}

void StartView::say_side(bones::Side side) {
  state_.side = side;
  state_.side_was_said = true;
  work_.set_side(side);  // of what was made, if anything was
}

void StartView::take(const fs::path& path) {
  std::error_code error;
  if (library::is_case_folder(path)) return open_(path);
  if (path.filename() == "case.json" && fs::exists(path, error)) return open_(path.parent_path());
  if (folders::is_markups_name(path) && !state_.open_case.empty()) {
    markups_ = path;
    wants_to_close_ = true;
    return;
  }
  leave();
  state_.page = Page::Import;
  state_.selected = 0;
  state_.ticked.clear();
  state_.side.reset();
  state_.side_was_said = false;
  state_.unit.reset();
  thumbnails_.clear();
  planned_.forget();
  work_.look_into(path);
}

bool StartView::has_running_work() const { return imports() || pacs_.has_running_work(); }

bool StartView::imports() const {
  return work_.state() == State::Running || work_.state() == State::Saving || work_.state() == State::Asking;
}

void StartView::tick() {
  if (state_.page == Page::Cases) cases_.tick();
  pacs_.tick(state_.page == Page::Pacs);
  const State before = work_.state();
  work_.poll();
  planned_.poll();
  const State now = work_.state();
  if (before == State::Looking && now == State::Choosing) {
    planned_.look_up(work_.sources());
    state_.ticked.clear();
    if (const auto best = work_.sources().best()) {
      state_.selected = *best;
      state_.scrolls_to_selected = true;  // wherever in the list it is
      state_.ticked = {*best};
      // Meshes of different bones are one knee's.
      const auto& sources = work_.sources().sources;
      if (!sources[*best].series)
        for (std::size_t i = 0; i < sources.size(); ++i)
          if (i != *best && !sources[i].series && sources[i].can_be_imported() &&
              sources[i].bone != sources[*best].bone) {
            state_.ticked.push_back(i);
            break;
          }
    }
  }
  if (before == State::Running && now == State::Asking) {
    state_.side = work_.result().side;
    made_.show(work_.result());
    // One that no case of the day has: two of one name would be told apart by their folders alone.
    state_.name =
        new_case_folder(cases_folder(), "Knee " + files::local_day(files::utc_now())).stem().string();
  }
  if (before == State::Running && asks_for_labels())
    state_.labels = importing::likely_labels(work_.refusal().labels);
  if (before == State::Saving && now == State::Done) {
    state_.page = Page::Cases;
    open_(work_.folder());
  }
}

std::size_t StartView::row_count() const {
  switch (state_.page) {
    case Page::Cases:
      return cases_.row_count();
    case Page::Browse:
      return browser_.has_rows() ? 1 : 0;  // it knows its own
    case Page::Import:
      return work_.state() == State::Choosing ? work_.sources().sources.size() : 0;
    case Page::Pacs:
      return 1;  // it knows its own
  }
  return 0;
}

void StartView::move_selection(int by) {
  if (state_.page == Page::Cases) return cases_.move_selection(by);
  if (state_.page == Page::Pacs) return pacs_.move_selection(by);
  if (state_.page == Page::Browse) return browser_.move_selection(by);
  const auto count = static_cast<long>(row_count());
  if (count == 0) return;
  state_.selected =
      static_cast<std::size_t>(std::clamp(static_cast<long>(state_.selected) + by, 0L, count - 1));
  state_.scrolls_to_selected = true;
  take_selected_volume();
}

void StartView::browse(std::string title) {
  state_.browse_title = std::move(title);
  state_.page = Page::Browse;
  browser_.enter();
}

void StartView::go_back() {
  switch (state_.page) {
    case Page::Cases:
      if (!cases_.go_back()) wants_to_close_ = !state_.open_case.empty();
      return;
    case Page::Browse:
      state_.page = Page::Cases;
      break;
    case Page::Pacs:
      if (pacs_.go_back()) return;
      state_.page = Page::Cases;
      break;
    case Page::Import:
      if (work_.state() == State::Running || work_.state() == State::Asking)
        work_.cancel();
      else if (work_.state() != State::Saving) {
        work_.cancel();
        state_.page = browser_.folder().empty() ? Page::Cases : Page::Browse;
      }
      break;
  }
  state_.selected = 0;
}

void StartView::accept_entry() {
  if (const auto found = browser_.open_selected()) take(*found);
}

void StartView::accept() {
  switch (state_.page) {
    case Page::Cases:
      return cases_.accept();
    case Page::Browse:
      return accept_entry();
    case Page::Import:
      if (work_.state() == State::Choosing) start_import();
      if (work_.state() == State::Asking) save_import();
      return;
    case Page::Pacs:
      return;  // by keys of its own
  }
}

void StartView::add_actions(widgets::Actions& actions) {
  add_page_actions(actions);
  add_import_actions(actions);
  cases_.add_actions(actions, [this] { return state_.page == Page::Cases; });
  pacs_.add_actions(actions, [this] { return state_.page == Page::Pacs; });
}

void StartView::add_page_actions(widgets::Actions& actions) {
  const auto here = [this](Page page) { return [this, page] { return state_.page == page; }; };
  actions.add({"start.built_in",
               "Built-in knee",
               "A knee to learn on; what is changed in it stays",
               GLFW_KEY_B,
               0,
               false,
               here(Page::Cases),
               {},
               [this] { open_({}); }});
  actions.add({"start.browse",
               "Open or import...",
               "Looks for a case, for images or for meshes in the folders of this machine",
               GLFW_KEY_O,
               0,
               false,
               here(Page::Cases),
               {},
               [this] { browse(); }});
  actions.add({"start.pacs",
               "PACS...",
               "Finds and fetches a patient's images in the hospital's archive; sends the results of the "
               "selected case there",
               GLFW_KEY_P,
               0,
               false,
               here(Page::Cases),
               {},
               [this] {
                 state_.page = Page::Pacs;
                 pacs_.enter(cases_.sendable(), state_.open_case);
               }});
  actions.add({"start.up",
               "Folder above",
               "Goes to the folder that this one is in",
               GLFW_KEY_BACKSPACE,
               0,
               false,
               here(Page::Browse),
               {},
               [this] { browser_.up(); }});
  actions.add({"start.home",
               "Home",
               "Goes to the user's own folder",
               GLFW_KEY_HOME,
               0,
               false,
               here(Page::Browse),
               {},
               [this] { browser_.home(); }});
  actions.add({"start.type_path",
               "Type a path",
               "Goes to a folder or a file whose path is typed or pasted: Tab completes it",
               GLFW_KEY_L,
               GLFW_MOD_CONTROL,
               false,
               here(Page::Browse),
               {},
               [this] { browser_.type_path(); }});
  actions.add({"start.import_folder",
               "Import this folder",
               "Looks for image series in this folder and all that are in it",
               GLFW_KEY_I,
               0,
               false,
               here(Page::Browse),
               {},
               [this] { take(browser_.folder()); }});
  struct Step {
    const char *id, *label;
    int key, by;
  };
  for (const Step& step :
       {Step{"start.previous", "Up", GLFW_KEY_UP, -1}, Step{"start.next", "Down", GLFW_KEY_DOWN, 1},
        Step{"start.page_up", "Ten up", GLFW_KEY_PAGE_UP, -10},
        Step{"start.page_down", "Ten down", GLFW_KEY_PAGE_DOWN, 10}})
    actions.add({step.id,
                 step.label,
                 "Goes through the list",
                 step.key,
                 0,
                 true,
                 [this] { return row_count() > 0; },
                 {},
                 [this, by = step.by] { move_selection(by); }});
  actions.add({"start.accept",
               "Open",
               "Opens what is selected",
               GLFW_KEY_ENTER,
               0,
               false,
               [this] { return state_.page != Page::Import && state_.page != Page::Pacs && row_count() > 0; },
               {},
               [this] { accept(); }});
  actions.add({"start.back",
               "Back",
               "Goes back; an import that runs is stopped, and nothing of it stays; of a transfer what came "
               "whole stays",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] {
                 return (state_.page != Page::Cases || !state_.open_case.empty() || cases_.shows_trends()) &&
                        work_.state() != State::Saving;
               },
               {},
               [this] { go_back(); },
               {"stop the import", [this] { return imports(); }}});
}

}  // namespace arthronaut::start
