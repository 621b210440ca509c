// Carries out the edits of the plan mode: each becomes a step of the undo history and is saved. Edits that
// follow each other as one movement (a drag, a key held down) are one step, saved when the hand rests.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/case/history.h"
#include "app/case/plan_edit.h"
#include "app/case/plan_model.h"

namespace arthronaut::open_case {

class PlanHistory {
 public:
  // Another case: forgets the steps. The model outlives this history's use of it. Null closes.
  void open(PlanModel* model, const std::filesystem::path& case_folder);

  void apply(const PlanEdit& edit, double now_s);
  void undo();
  void redo();
  [[nodiscard]] bool can_undo() const;
  [[nodiscard]] bool can_redo() const;

  // Ends a movement that has rested for half a second, which saves it.
  void settle(double now_s);
  void settle_now();
  [[nodiscard]] bool is_moving() const { return history_ != nullptr && history_->is_dragging(); }
  [[nodiscard]] const PlanStatus& status() const { return status_; }

 private:
  void save();
  void describe();

  PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  std::unique_ptr<History> history_;
  std::string movement_;  // what the open movement does, and of which bone
  double moved_at_s_ = 0;
  PlanStatus status_;
};

}  // namespace arthronaut::open_case
