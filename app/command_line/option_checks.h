// Checks of options' values, made before any work. CLI11's own let NaN pass, and name limits of 309 digits:
// every option that takes a fraction has one of these.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace arthronaut::command_line {

[[nodiscard]] CLI::Validator between(double least, double greatest);
[[nodiscard]] CLI::Validator finite();
[[nodiscard]] CLI::Validator above_zero();  // and finite
// What `read` throws of a value is what is wrong with it.
[[nodiscard]] CLI::Validator read_by(std::function<void(const std::string&)> read);

}  // namespace arthronaut::command_line
