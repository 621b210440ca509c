#include "app/start/case_list.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/library/workstation_library.h"

namespace arthronaut::start {

namespace fs = std::filesystem;
using library::CaseRecord;
using library::CaseState;

namespace {

// Either, the first, the second, and either again.
template <typename T>
std::optional<T> after(const std::optional<T>& now, T first, T second) {
  if (!now) return first;
  return *now == first ? std::optional(second) : std::nullopt;
}

}  // namespace

CaseList::CaseList(std::function<void(const fs::path&)> open, std::function<void()> wake)
    : open_(std::move(open)), library_(workstation_library::data_folder(), wake), pictures_(wake) {}

void CaseList::enter() {
  recent_ = load_recent_cases(recent_cases_file());
  std::vector<fs::path> folders;
  for (const RecentCase& recent : recent_) folders.push_back(recent.folder);
  library_.refresh(folders);
  accuracy_ = library::read_accuracy_checks(workstation_library::data_folder());
  devices_ = library::devices_of(accuracy_);
  view_.chart = std::min(view_.chart, chart_count() - 1);
  pictures_.forget_all();
  view_.shows_trends = false;
  view_.has_chosen = false;
  filter();
}

void CaseList::leave() {
  keep_note();
  pictures_.finish();
}

void CaseList::keep_note() {
  if (view_.note_of.empty() || view_.note == view_.note_before) return;
  if (!library_.save_note(view_.note_of, view_.note, view_.note_before)) return;
  view_.note_before = view_.note;
  filter();
}

void CaseList::tick() {
  if (library_.poll()) filter();
  pictures_.poll();
}

std::string CaseList::used_utc(const CaseRecord& record) const {
  const auto recent =
      std::ranges::find_if(recent_, [&](const RecentCase& one) { return one.folder == record.folder; });
  return recent == recent_.end() ? record.changed_utc : std::max(recent->opened_utc, record.changed_utc);
}

// What was opened last is first, also where it was only looked at.
void CaseList::filter() {
  found_ = library::find_cases(library_.records(), view_.query, &library_.identities());
  found_by_patient_.clear();
  if (!view_.query.words.empty()) {
    for (const std::size_t i : found_) found_by_patient_.insert(library_.records()[i].folder);
    for (const std::size_t i : library::find_cases(library_.records(), view_.query))
      found_by_patient_.erase(library_.records()[i].folder);
  }
  if (view_.query.order == library::CaseOrder::Newest) {
    const auto used = [&](std::size_t i) { return used_utc(library_.records()[i]); };
    std::stable_sort(found_.begin(), found_.end(),
                     [&](std::size_t a, std::size_t b) { return used(a) > used(b); });
  }
  // What is being written stays with the case that it is about, whatever a look at the folders brings.
  if (is_writing() && selected_row() == found_.size()) {
    for (std::size_t i = 0; i < library_.records().size(); ++i)
      if (library_.records()[i].folder == view_.selected) found_.push_back(i);
  }
  const bool is_listed = view_.selected.empty() || selected_row() < found_.size();
  if (!is_listed || !(view_.has_chosen || is_writing()))
    view_.selected = found_.empty() ? fs::path() : library_.records()[found_.front()].folder;
}

const CaseRecord* CaseList::selected() const {
  const std::size_t row = selected_row();
  return row < found_.size() ? &library_.records()[found_[row]] : nullptr;
}

bool CaseList::lists_built_in() const {
  const library::CaseQuery& query = view_.query;
  return query.words.empty() && !query.side && !query.state;
}

std::size_t CaseList::selected_row() const {
  return static_cast<std::size_t>(
      std::find_if(found_.begin(), found_.end(),
                   [&](std::size_t i) { return library_.records()[i].folder == view_.selected; }) -
      found_.begin());
}

void CaseList::move_selection(int by) {
  if (view_.shows_trends) {
    const long next =
        std::clamp(static_cast<long>(view_.chart) + by, 0L, static_cast<long>(chart_count()) - 1);
    view_.chart = static_cast<std::size_t>(next);
    return;
  }
  if (is_first_look() || row_count() == 0) return;
  const long row = std::clamp(static_cast<long>(selected_row()) + by, 0L, static_cast<long>(row_count()) - 1);
  view_.selected = row < static_cast<long>(found_.size())
                       ? library_.records()[found_[static_cast<std::size_t>(row)]].folder
                       : fs::path();
  view_.has_chosen = view_.scrolls_to_selected = true;
}

void CaseList::accept() {
  if (view_.shows_trends || is_first_look() || selected_row() >= row_count()) return;
  open_(view_.selected);
}

SendableCase CaseList::sendable() const {
  const CaseRecord* record = selected();
  if (record == nullptr || !record->is_there || !record->problem.empty()) return {};
  const plan_review::TunnelVerdict* const plan = pictures_.verdict_of(record->folder);
  return {record->folder, record->name, plan != nullptr ? std::optional(*plan) : std::nullopt};
}

bool CaseList::go_back() { return std::exchange(view_.shows_trends, false); }

void CaseList::add_actions(widgets::Actions& actions, const std::function<bool()>& is_shown) {
  const auto lists = [this, is_shown] { return is_shown() && !view_.shows_trends; };
  actions.add(
      {"start.search",
       "Search",
       "Words that must all stand in name, note, side, date, state, outcome or what names the patient; Enter "
       "gives the keys back, Esc clears it",
       GLFW_KEY_F,
       0,
       false,
       lists,
       {},
       [this] { view_.focus = Focus::Search; }});
  actions.add({"start.note",
               "Note",
               "Writes a note on the selected case; it is kept in the case's folder",
               GLFW_KEY_N,
               0,
               false,
               [this, lists] { return lists() && selected() != nullptr && selected()->is_there; },
               {},
               [this] {
                 view_.has_chosen = true;
                 view_.focus = Focus::Note;
               }});
  actions.add({"start.trends", "Trends",
               "Offsets, angles, confidence and minutes a step of the listed cases over time, and the daily "
               "checks of "
               "accuracy, with control limits",
               GLFW_KEY_T, 0, false, is_shown, [this] { return view_.shows_trends; },
               [this] { view_.shows_trends = !view_.shows_trends; }});
  actions.add({"start.simulated", "Simulated too", "Counts simulated sessions among the trends",
               GLFW_KEY_SPACE, 0, false, [this, is_shown] { return is_shown() && view_.shows_trends; },
               [this] { return view_.with_simulated; },
               [this] { view_.with_simulated = !view_.with_simulated; }});
  actions.add({"start.trend_bone", "Femur, tibia or both",
               "Which bone's tunnels and sessions the trends are of, and their limits", GLFW_KEY_TAB, 0,
               false, [this, is_shown] { return is_shown() && view_.shows_trends; },
               [this] { return view_.trend_bone.has_value(); },
               [this] {
                 view_.trend_bone = after(view_.trend_bone, bones::BoneKind::Femur, bones::BoneKind::Tibia);
               }});
  actions.add({"start.forget",
               "Take off the list",
               "The missing case is not listed any more; nothing is deleted",
               GLFW_KEY_DELETE,
               0,
               false,
               [this, lists] {  // A look that goes on would bring it back.
                 return lists() && !library_.is_looking() && selected() != nullptr && !selected()->is_there;
               },
               {},
               [this] {
                 (void)library_.forget(fs::path(view_.selected));
                 filter();
               }});
  add_filter_actions(actions, lists);
}

void CaseList::add_filter_actions(widgets::Actions& actions, const std::function<bool()>& lists) {
  actions.add({"start.side", "Side", "Both sides, left knees, right knees", GLFW_KEY_S, 0, false, lists,
               [this] { return view_.query.side.has_value(); },
               [this] {
                 view_.query.side = after(view_.query.side, bones::Side::Left, bones::Side::Right);
                 filter();
               }});
  actions.add({"start.state", "State", "Cases in any state, then those in one", GLFW_KEY_A, 0, false, lists,
               [this] { return view_.query.state.has_value(); },
               [this] {
                 constexpr std::array<CaseState, 6> kInTurn{CaseState::NotPlanned, CaseState::Planned,
                                                            CaseState::Navigated,  CaseState::Drilled,
                                                            CaseState::Missing,    CaseState::Unreadable};
                 auto& state = view_.query.state;
                 if (!state)
                   state = kInTurn.front();
                 else if (state == kInTurn.back())
                   state.reset();
                 else
                   state = *(std::find(kInTurn.begin(), kInTurn.end(), *state) + 1);
                 filter();
               }});
  actions.add({"start.order", "Order", "Newest first, by name, by date, by state, by the offset of the entry",
               GLFW_KEY_D, 0, false, lists,
               [this] { return view_.query.order != library::CaseOrder::Newest; },
               [this] {
                 constexpr int kCount = 5;
                 view_.query.order =
                     static_cast<library::CaseOrder>((static_cast<int>(view_.query.order) + 1) % kCount);
                 filter();
               }});
}

}  // namespace arthronaut::start
