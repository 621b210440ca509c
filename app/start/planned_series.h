// Of which cases the series of an import's list may be the images after the operation; looked up beside the
// screen. One thread.
#pragma once

#include <functional>
#include <vector>

#include "app/start/import_sources.h"
#include "navigation/worker/awaited.h"
#include "planning/library/planned_cases.h"

namespace arthronaut::start {

class PlannedSeries {
 public:
  explicit PlannedSeries(std::function<void()> wake) : wake_(std::move(wake)) {}

  void look_up(const ImportSources& sources);
  void forget();
  void poll();
  [[nodiscard]] bool is_busy() const { return looking_.is_busy(); }
  // The newest case of that source's patient with a plan; null: none, or not known yet.
  [[nodiscard]] const library::PlannedCase* of(std::size_t source) const;

 private:
  using Cases = std::vector<std::vector<library::PlannedCase>>;  // by source
  std::function<void()> wake_;
  Cases cases_;
  worker::Awaited<Cases> looking_;
};

// "The case "Knee 7" is of this patient and has a plan. Press A: ..."
[[nodiscard]] std::string offer_in_words(const library::PlannedCase& planned);

}  // namespace arthronaut::start
