// How one case takes the place of another.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "app/case/case_side.h"
#include "app/folders/folder_listing.h"
#include "app/library/workstation_library.h"
#include "app/plan/plan_view.h"
#include "app/review/review_view.h"
#include "app/window/workstation_window.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::window {

namespace {

using widgets::GraphicsWindow;

}  // namespace

void WorkstationWindow::open(const std::filesystem::path& folder) {
  if (opening_ != nullptr || has_running_work()) return;
  const std::filesystem::path wanted = folder.empty() ? open_case::built_in_case_folder() : folder;
  std::error_code error;
  if (case_ != nullptr && std::filesystem::equivalent(wanted, case_->folder(), error)) {
    close_start();  // it is open
    return;
  }
  failure_.clear();
  lender_ = nullptr;
  const auto wake = [] { GraphicsWindow::wake(); };
  // One that the modes still know is this program's already.
  if (known_to_modes_ != nullptr && std::filesystem::equivalent(wanted, known_to_modes_->folder(), error))
    lender_ = known_to_modes_.get();
  opening_ = lender_ != nullptr ? std::make_unique<open_case::CaseOpening>(*lender_, wake)
                                : std::make_unique<open_case::CaseOpening>(folder, wake);
}

// While the bones of the open case are others now there is no way back to those that were.
bool WorkstationWindow::can_stop_opening() const {
  return opening_ != nullptr && !opening_->is_cancelled() && (lender_ == nullptr || lender_ != case_.get());
}

void WorkstationWindow::draw_opening(const widgets::Ui& ui, const widgets::Rect& area) const {
  widgets::Rect rest = area;
  widgets::text_centered(ui, rest.cut_top(area.height / 2), ui.theme.title, widgets::kText,
                         opening_->is_cancelled() ? "Stopping" : "Opening the case");
  const float width = area.width / 2, height = ui.theme.px(24);
  const ImVec2 at(area.x + area.width / 4, rest.y + ui.theme.px(20));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + width, at.y + height}, widgets::kPanelEdge, ui.theme.px(6));
  draw.AddRectFilled(at, {at.x + width * static_cast<float>(opening_->done_fraction()), at.y + height},
                     widgets::kAccent, ui.theme.px(6));
  if (can_stop_opening())
    widgets::draw_buttons(ui, {at.x, at.y + ui.theme.px(60), width, ui.theme.px(56)}, {"app.stop_opening"});
}

void WorkstationWindow::take_opened_case() {
  if (opening_ == nullptr) return;
  const bool is_open = opening_->take();
  if (!is_open && opening_->is_busy()) return;
  if (!is_open) {
    failure_ = opening_->failure();
    if (lender_ != nullptr) lender_->keep_lock(*opening_);
    opening_.reset();
    return;
  }
  leave_shown();
  // The one before is let go when no mode knows it any more.
  std::unique_ptr<open_case::CaseOpening> before = std::exchange(case_, std::move(opening_));
  const bool is_same_folder = before != nullptr && before->folder() == case_->folder();
  lender_ = nullptr;
  bool all_know = model() != nullptr;
  if (model() != nullptr)
    for (const auto& mode : modes_)
      all_know &= guarded([&] {
        mode->case_opened(
            {model(), case_->folder(), case_->read_only_reason(), case_->left_by_crash_since()});
      });
  if (all_know)
    let_go(std::move(known_to_modes_));
  else if (before != nullptr && before->model() != nullptr)
    known_to_modes_ = std::move(before);
  let_go(std::move(before));
  if (!is_same_folder) paint_.close();
  const cases::Case& knee = is_unpainted() ? *case_->unpainted() : model()->knee();
  if (is_unpainted()) paint_.open(knee, case_->folder(), case_->is_read_only());
  start::note_recent_case(
      start::recent_cases_file(),
      {case_->folder(), knee.name, std::string(bones::to_text(knee.side)), files::utc_now()});
  workstation_library::note_case(case_->folder());
  start_.leave();  // it may have begun a picture since, and Plan draws from here on
  const bool is_new_here = !is_same_folder || shows_paint_;
  shows_start_ = shows_paint_ = false;
  // Where nothing is planned there is nothing to set up for, to drill or to look back at: Plan comes first.
  if (!is_unpainted() && is_new_here && model()->knee().plan.tunnels.empty()) shown_ = 0;
  if (case_->is_read_only() && !shown().works_read_only()) shown_ = 0;
  // Opened once more, as when the program that died has let go of it, it is still looked for.
  looks_for_cut_off_ = all_know && (looks_for_cut_off_ || !is_same_folder) && !is_unpainted();
  if (!is_unpainted()) shown().enter();
}

void WorkstationWindow::let_go(std::unique_ptr<open_case::CaseOpening> closed) {
  if (closed != nullptr) closed->release_lock();
  letting_go_.take(std::move(closed));
}

void WorkstationWindow::reopen() {
  if (opening_ != nullptr) return;
  lender_ = case_.get();
  opening_ = std::make_unique<open_case::CaseOpening>(*case_, [] { GraphicsWindow::wake(); });
}

std::vector<std::string> WorkstationWindow::say_side(bones::Side side) {
  if (case_ == nullptr || case_->is_read_only()) throw InvalidInput("the case can only be looked at");
  if (opening_ != nullptr || has_running_work())
    throw InvalidInput("something runs in this case: end it, then say which knee it is");
  const auto said = open_case::say_side(case_->folder(), side);
  if (said.is_changed) reopen();
  return said.lines;
}

// A window that died, or was closed in another room, takes its case with it no longer than it is there: who
// waits with the case on the screen need not open it again. Not while somebody works in what is open.
void WorkstationWindow::take_over_when_free() {
  constexpr double kLookEvery_s = 1;
  const double now_s = GraphicsWindow::now_s();
  if (case_ == nullptr || opening_ != nullptr || has_running_work() ||
      now_s - looked_for_lock_s_ < kLookEvery_s)
    return;
  looked_for_lock_s_ = now_s;
  if (case_->take_when_free()) reopen();
}

// Nobody's text or drag is interrupted.
void WorkstationWindow::offer_cut_off() {
  if (!looks_for_cut_off_ || opening_ != nullptr || has_running_work() || shows_start() || shows_paint())
    return;
  if (ImGui::GetIO().WantTextInput || ImGui::IsAnyMouseDown()) return;
  for (std::size_t i = 0; i < modes_.size() && looks_for_cut_off_; ++i)
    if (modes_[i]->asks_for_front()) show(i);
}

void WorkstationWindow::take_dropped() {
  const auto dropped = window_.take_dropped();
  if (dropped.empty()) return;
  if (has_running_work() || opening_ != nullptr) return untaken_.note_drop(GraphicsWindow::now_s());
  failure_.clear();
  const mode::Mode* const in_front = shows_start() || shows_paint() ? nullptr : &shown();
  if (in_front == plan_ && in_front != nullptr && folders::is_markups_name(dropped.front()))
    return plan_->take_markups(dropped.front());
  // In Review what is dropped is what the case looks like now, unless it is another case.
  if (in_front == review_ && in_front != nullptr && !std::filesystem::exists(dropped.front() / "case.json"))
    return review_->take_dropped(dropped.front());
  leave_shown();
  shows_start_ = true;
  start_.enter(case_ != nullptr ? case_->folder() : std::filesystem::path());
  start_.take(dropped.front());
}

void WorkstationWindow::add_markups_action() {
  actions_.add(
      {"plan.markups",
       "Take markups",
       "The tunnels as 3D Slicer's markups (.mrk.json) have them: choose the file, or drop it on this "
       "window",
       GLFW_KEY_M,
       GLFW_MOD_CONTROL,
       false,
       [this] {
         return model() != nullptr && opening_ == nullptr && plan_ != nullptr && &shown() == plan_ &&
                !shows_start() && !shows_paint() && !case_->is_read_only() && !has_running_work();
       },
       {},
       [this] {
         leave_shown();
         shows_start_ = true;
         start_.enter(case_->folder());
         start_.browse("Take markups: choose the file of 3D Slicer's markups (.mrk.json)");
       }});
}

void WorkstationWindow::take_chosen_markups() {
  const auto chosen = start_.take_markups();
  if (!chosen || model() == nullptr || plan_ == nullptr) return;
  for (std::size_t mode = 0; mode < modes_.size(); ++mode)
    if (modes_[mode].get() == plan_) show(mode);
  plan_->take_markups(*chosen);
}

// Its case may be another than the open one, and is opened first.
void WorkstationWindow::compare_chosen() {
  if (auto chosen = start_.take_after_operation()) {
    after_operation_ = std::move(chosen);
    open(after_operation_->case_folder);
  }
  if (!after_operation_ || opening_ != nullptr) return;
  const start::AfterOperation chosen = *std::exchange(after_operation_, std::nullopt);
  std::error_code gone;
  if (model() == nullptr || review_ == nullptr ||
      !std::filesystem::equivalent(chosen.case_folder, case_->folder(), gone))
    return;  // it could not be opened, which is said
  for (std::size_t mode = 0; mode < modes_.size(); ++mode)
    if (modes_[mode].get() == review_) show(mode);
  review_->take_dropped(chosen.source, chosen.series);
}

}  // namespace arthronaut::window
