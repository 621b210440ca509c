#include "app/start/planned_series.h"

#include "app/library/workstation_library.h"

namespace arthronaut::start {

void PlannedSeries::look_up(const ImportSources& sources) {
  forget();
  std::vector<library::TakenImages> images;
  for (const ImportSource& source : sources.sources) {
    library::TakenImages& taken = images.emplace_back();
    if (source.series && source.can_be_imported()) taken = library::taken_images(*source.series);
  }
  looking_.start([images = std::move(images)] { return workstation_library::planned_cases_of(images); },
                 wake_);
}

void PlannedSeries::forget() {
  looking_.drop();
  cases_.clear();
}

void PlannedSeries::poll() {
  if (looking_.is_ready()) cases_ = looking_.take();
}

const library::PlannedCase* PlannedSeries::of(std::size_t source) const {
  return source < cases_.size() && !cases_[source].empty() ? &cases_[source].front() : nullptr;
}

std::string offer_in_words(const library::PlannedCase& planned) {
  return "The case \"" + planned.name +
         "\" is of this patient and has a plan. Press A where these images were taken after the operation: "
         "they are compared with it";
}

}  // namespace arthronaut::start
