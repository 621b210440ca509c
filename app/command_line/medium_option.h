// The option --medium, alike in every subcommand that looks through the arthroscope.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace arthronaut::command_line {

// "air", "water", "saline" or a refractive index in [1, 2]; anything else is wrong usage. `index` stays empty
// when the option is not given.
CLI::Option* add_medium_option(CLI::App& subcommand, std::optional<double>& index,
                               const std::string& description);

}  // namespace arthronaut::command_line
