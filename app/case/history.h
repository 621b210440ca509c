// Undo and redo of everything a planner does. Doing is redo: a step is executed by the history and only by
// it.
//
// GUI-free. One thread. Every executed, undone or redone step ends in one call of the save function, so that
// what is on disk is always the last state; a crash resumes there.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace arthronaut::open_case {

// One undoable step.
class Step {
 public:
  virtual ~Step() = default;
  virtual void redo() = 0;  // may throw: the model is then as before
  virtual void undo() = 0;
  [[nodiscard]] virtual std::string describe() const = 0;  // "Move femoral entry"
  // A drag is one step: takes `later` into this step and returns true when both are parts of the same drag.
  virtual bool absorb(const Step& later) {
    (void)later;
    return false;
  }
};

class History {
 public:
  // save is called after each change of the model; what it throws reaches the caller, the model keeps the
  // change.
  explicit History(std::function<void()> save);

  // Executes the step. While a drag is open, it is taken into the drag's one step and not yet saved.
  void execute(std::unique_ptr<Step> step);
  void begin_drag();
  void end_drag();  // saves
  [[nodiscard]] bool is_dragging() const { return is_dragging_; }

  [[nodiscard]] bool can_undo() const { return position_ > 0 && !is_dragging_; }
  [[nodiscard]] bool can_redo() const { return position_ < steps_.size() && !is_dragging_; }
  // Without effect when there is nothing to undo or redo.
  void undo();
  void redo();
  [[nodiscard]] std::string undo_text() const;  // empty when there is nothing
  [[nodiscard]] std::string redo_text() const;

 private:
  std::function<void()> save_;
  std::vector<std::unique_ptr<Step>> steps_;
  std::size_t position_ = 0;    // steps_[0, position_) are done
  std::size_t drag_start_ = 0;  // position_ when the drag began
  bool is_dragging_ = false;
};

}  // namespace arthronaut::open_case
