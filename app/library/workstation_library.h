// The library of this user on this workstation.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "planning/library/library.h"
#include "planning/library/planned_cases.h"

namespace arthronaut::workstation_library {

// Beside the built-in case: $XDG_DATA_HOME/arthronaut, else ~/.local/share/arthronaut.
[[nodiscard]] std::filesystem::path data_folder();

// With the sessions' facts from their records. Throws as library::Library.
[[nodiscard]] std::unique_ptr<library::Library> open_library(
    const std::filesystem::path& folder = data_folder());

// A case that was made or opened just now is in the list from now on. What goes wrong is logged and no
// failure: `cases --add` finds the case again.
void note_case(const std::filesystem::path& case_folder,
               const std::filesystem::path& folder = data_folder()) noexcept;

// Of each of these images the cases that they may be of, taken after the operation
// (library::planned_cases_of), with a look at every case. What goes wrong is logged and no failure: there are
// none then.
[[nodiscard]] std::vector<std::vector<library::PlannedCase>> planned_cases_of(
    std::span<const library::TakenImages> images,
    const std::filesystem::path& folder = data_folder()) noexcept;

}  // namespace arthronaut::workstation_library
