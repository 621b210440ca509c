// The registration that `navigate` begins with, where one is known. Inner header of command_line.
#pragma once

#include <filesystem>
#include <optional>

#include "app/command_line/command.h"
#include "navigation/theatre/navigate_source.h"
#include "planning/cases/case.h"

namespace arthronaut::command_line {

// given: a registration.json by name; empty: the newest session of the case is asked, whose bone `options`
// name. What is told of it goes to `context`.
//
// A registration that was given by name and is of something else is refused; one of the case is passed over,
// and so is any of it where live pictures are to guide.
// Throws InvalidInput.
[[nodiscard]] std::optional<operation::GiveRegistration> known_registration(
    const Context& context, const std::filesystem::path& given, const std::filesystem::path& case_folder,
    const cases::Case& knee, const theatre::NavigateOptions& options);

}  // namespace arthronaut::command_line
