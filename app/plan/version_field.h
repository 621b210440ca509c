// Where a kept version gets its name and its note, below its row in the list.
#pragma once

#include <optional>

#include "app/widgets/controls.h"
#include "planning/cases/plan_versions.h"

namespace arthronaut::plan {

class VersionField {
 public:
  void open(const cases::PlanVersion& version) {
    number_ = version.number;
    words_ = version.words;
    takes_focus_ = true;
  }
  void close() { *this = {}; }
  [[nodiscard]] bool is_of(int number) const { return number_ == number; }
  // It was opened in this frame and has not the keyboard yet.
  [[nodiscard]] bool awaits_text() const { return takes_focus_; }
  // What was entered for the version that it is of, once; Esc closes it.
  [[nodiscard]] std::optional<cases::VersionWords> draw(const widgets::Ui& ui);

 private:
  int number_ = 0;  // 0: closed
  cases::VersionWords words_;
  bool takes_focus_ = false;
};

}  // namespace arthronaut::plan
