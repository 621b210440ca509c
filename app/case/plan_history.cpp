#include "app/case/plan_history.h"

#include <array>
#include <ctime>

#include "app/case/plan_steps.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

constexpr double kRest_s = 0.5;

std::string clock_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%H:%M:%S", &parts);
  return text.data();
}

}  // namespace

void PlanHistory::open(PlanModel* model, const std::filesystem::path& case_folder) {
  model_ = model;
  case_folder_ = case_folder;
  history_ = model != nullptr ? std::make_unique<History>([this] { save(); }) : nullptr;
  status_ = {};
  status_.saved = "saved";
}

void PlanHistory::apply(const PlanEdit& edit, double now_s) {
  if (history_ == nullptr) return;
  if (history_->is_dragging() && (!edit.continues || edit.what != movement_)) history_->end_drag();
  if (!history_->is_dragging()) history_->begin_drag();
  movement_ = edit.what;
  moved_at_s_ = now_s;
  const TunnelSetter set = [model = model_](bones::BoneKind bone,
                                            const std::optional<tunnels::Tunnel>& tunnel) {
    model->set_tunnel(bone, tunnel);
  };
  history_->execute(set_tunnel(set, edit.bone, model_->tunnel(edit.bone), edit.tunnel, edit.what));
  status_.saved = "not saved yet";
  describe();
}

void PlanHistory::undo() {
  if (!can_undo()) return;
  settle_now();
  history_->undo();
  describe();
}

void PlanHistory::redo() {
  if (!can_redo()) return;
  settle_now();
  history_->redo();
  describe();
}

bool PlanHistory::can_undo() const {
  return history_ != nullptr && (history_->is_dragging() || history_->can_undo());
}
bool PlanHistory::can_redo() const { return history_ != nullptr && history_->can_redo(); }

void PlanHistory::settle(double now_s) {
  if (is_moving() && now_s - moved_at_s_ > kRest_s) settle_now();
}

void PlanHistory::settle_now() {
  if (!is_moving()) return;
  history_->end_drag();
  describe();
}

void PlanHistory::describe() {
  status_.undo_what = history_->is_dragging() ? movement_ : history_->undo_text();
  status_.redo_what = history_->redo_text();
}

void PlanHistory::save() {
  try {  // a disk that is full is a state of the screen, not the end of the frame
    cases::save_plan(case_folder_, model_->knee().plan);
    status_.save_failed = false;
    status_.saved = "saved at " + clock_text();
  } catch (const IoError& error) {
    status_.save_failed = true;
    status_.saved = std::string("not saved: ") + error.what();
  }
}

}  // namespace arthronaut::open_case
