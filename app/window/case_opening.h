// From a folder to what the workstation works on.
#pragma once

#include <filesystem>
#include <memory>

#include "app/planning_view/plan_model.h"

namespace arthronaut::window {

struct OpenedCase {
  std::filesystem::path folder;
  std::unique_ptr<planning_view::PlanModel> model;
};

// Where the built-in case lives: $XDG_DATA_HOME/arthronaut/Phantom.arthro, else ~/.local/share/..., so that
// what a user changes in it stays.
[[nodiscard]] std::filesystem::path built_in_case_folder();

// Loads the case and makes its bones ready, which takes seconds: for a job. An empty path is the built-in
// case, made anew when it is not there. Throws IoError or InvalidInput.
[[nodiscard]] OpenedCase open_case(const std::filesystem::path& folder);

}  // namespace arthronaut::window
