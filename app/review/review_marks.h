// The marks of a session that is looked at, with undo. Every change is on disk when the call returns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/recording/session_marks.h"

namespace arthronaut::review {

class MarkBook {
 public:
  MarkBook() = default;
  // read_only: why nothing may be written into the case; empty where it may. A broken file is told by
  // problem(), and is not written over.
  MarkBook(const std::filesystem::path& session_folder, const std::string& read_only);

  [[nodiscard]] const recording::SessionMarks& marks() const { return steps_[at_]; }
  [[nodiscard]] const recording::SessionMark* find(std::int64_t frame) const;  // null: none there
  // Why nothing can be marked; empty when it can.
  [[nodiscard]] const std::string& problem() const { return problem_; }

  // All of them throw IoError; the marks are then as before. A change that changes nothing is no step.
  void put(const recording::SessionMark& mark);
  void remove(std::int64_t frame);
  void undo();
  void redo();
  [[nodiscard]] bool can_undo() const { return at_ > 0; }
  [[nodiscard]] bool can_redo() const { return at_ + 1 < steps_.size(); }

 private:
  void step(recording::SessionMarks marks);

  std::filesystem::path folder_;
  std::string problem_;
  std::vector<recording::SessionMarks> steps_{{}};  // never empty
  std::size_t at_ = 0;
};

}  // namespace arthronaut::review
