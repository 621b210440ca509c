#include "app/review/review_marks.h"

#include <algorithm>
#include <utility>

#include "planning/geometry/error.h"

namespace arthronaut::review {

MarkBook::MarkBook(const std::filesystem::path& session_folder, const std::string& read_only)
    : folder_(session_folder), problem_(read_only) {
  try {
    steps_ = {recording::read_marks(folder_)};
  } catch (const InvalidInput& error) {
    problem_ = error.what();
  } catch (const IoError& error) {
    problem_ = error.what();
  }
}

const recording::SessionMark* MarkBook::find(std::int64_t frame) const {
  const auto found = std::find_if(marks().begin(), marks().end(),
                                  [&](const recording::SessionMark& mark) { return mark.frame == frame; });
  return found == marks().end() ? nullptr : &*found;
}

void MarkBook::put(const recording::SessionMark& mark) { step(recording::with_mark(marks(), mark)); }

void MarkBook::remove(std::int64_t frame) { step(recording::without_mark(marks(), frame)); }

void MarkBook::undo() {
  if (!can_undo()) return;
  recording::write_marks(folder_, steps_[at_ - 1]);
  --at_;
}

void MarkBook::redo() {
  if (!can_redo()) return;
  recording::write_marks(folder_, steps_[at_ + 1]);
  ++at_;
}

void MarkBook::step(recording::SessionMarks marks) {
  if (!problem_.empty() || marks == this->marks()) return;
  recording::write_marks(folder_, marks);
  steps_.resize(at_ + 1);
  steps_.push_back(std::move(marks));
  ++at_;
}

}  // namespace arthronaut::review
