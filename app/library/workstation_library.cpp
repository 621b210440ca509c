#include "app/library/workstation_library.h"

#include <algorithm>
#include <array>
#include <exception>
#include <string>

#include "app/case/case_opening.h"
#include "navigation/recording/session_facts.h"
#include "planning/log/log.h"

namespace arthronaut::workstation_library {

namespace fs = std::filesystem;

fs::path data_folder() { return open_case::built_in_case_folder().parent_path(); }

std::unique_ptr<library::Library> open_library(const fs::path& folder) {
  return std::make_unique<library::Library>(folder, recording::read_session_facts);
}

void note_case(const fs::path& case_folder, const fs::path& folder) noexcept {
  try {
    const std::array<fs::path, 1> folders{case_folder};
    open_library(folder)->add_those_there(folders);
  } catch (const std::exception& error) {  // as the header says
    log::warning(std::string("not in the list of cases: ") + error.what());
  }
}

std::vector<std::vector<library::PlannedCase>> planned_cases_of(std::span<const library::TakenImages> images,
                                                                const fs::path& folder) noexcept {
  std::vector<std::vector<library::PlannedCase>> cases(images.size());
  try {
    const auto names_a_patient = [](const library::TakenImages& one) {
      return !one.patient.patient_id.empty();
    };
    if (std::ranges::none_of(images, names_a_patient)) return cases;
    const std::vector<library::CaseRecord> records = open_library(folder)->look();
    for (std::size_t i = 0; i < images.size(); ++i) cases[i] = library::planned_cases_of(records, images[i]);
  } catch (const std::exception& error) {  // as the header says
    log::warning(std::string("whether a case is of these images' patient is not known: ") + error.what());
  }
  return cases;
}

}  // namespace arthronaut::workstation_library
