// Images of a patient of whom this workstation has a case with a plan: they may be those after the operation.
#pragma once

#include <filesystem>
#include <string>

#include "app/command_line/command.h"
#include "planning/images/series_list.h"
#include "planning/library/planned_cases.h"

namespace arthronaut::command_line {

// What a series says of itself.
[[nodiscard]] library::TakenImages taken_images(const images::ImageSeries& series);
// Which case they belong to and the command that compares them with its plan; nothing where there is none.
// source: what `compare` is given.
void say_planned_cases(const Context& context, const library::TakenImages& images, const std::string& source);

}  // namespace arthronaut::command_line
