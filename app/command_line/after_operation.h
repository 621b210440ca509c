// Images of a patient of whom this workstation has a case with a plan: they may be those after the operation.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "app/command_line/command.h"
#include "planning/images/series_list.h"
#include "planning/library/planned_cases.h"

namespace arthronaut::command_line {

// Of each of these series the cases of its patient that have a plan, by one look at the library.
[[nodiscard]] std::vector<std::vector<library::PlannedCase>> planned_cases_of(
    std::span<const images::ImageSeries> series);
// Which cases they are and the command that compares the images with each one's plan; nothing where there are
// none. series_uid: may be empty; source: what `compare` is given.
void say_planned_cases(const Context& context, std::span<const library::PlannedCase> cases,
                       const std::string& series_uid, const std::string& source);

// The same as JSON: name and folder of each.
[[nodiscard]] nlohmann::ordered_json planned_cases_json(std::span<const library::PlannedCase> cases);

}  // namespace arthronaut::command_line
