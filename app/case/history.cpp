#include "app/case/history.h"

#include <utility>

namespace arthronaut::open_case {

History::History(std::function<void()> save) : save_(std::move(save)) {}

void History::execute(std::unique_ptr<Step> step) {
  step->redo();
  steps_.resize(position_);  // what was undone can't be redone after a new step
  const bool is_same_drag = is_dragging_ && position_ > drag_start_ && steps_.back()->absorb(*step);
  if (!is_same_drag) {
    steps_.push_back(std::move(step));
    position_ = steps_.size();
  }
  if (!is_dragging_) save_();
}

void History::begin_drag() {
  is_dragging_ = true;
  drag_start_ = position_;
}

void History::end_drag() {
  const bool has_changed = std::exchange(is_dragging_, false) && position_ > drag_start_;
  if (has_changed) save_();
}

void History::undo() {
  if (!can_undo()) return;
  steps_[position_ - 1]->undo();
  --position_;
  save_();
}

void History::redo() {
  if (!can_redo()) return;
  steps_[position_]->redo();
  ++position_;
  save_();
}

std::string History::undo_text() const { return can_undo() ? steps_[position_ - 1]->describe() : ""; }
std::string History::redo_text() const { return can_redo() ? steps_[position_]->describe() : ""; }

}  // namespace arthronaut::open_case
