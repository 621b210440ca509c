// A number as a hand types it into a field.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace arthronaut::files {

// With a point or a comma, blanks anywhere, the unit behind it or not: "21,5", " 21.5 mm". nullopt for
// anything else, such as "1.234,5", of which nobody knows what it says.
[[nodiscard]] std::optional<double> typed_number(std::string text, std::string_view unit);

}  // namespace arthronaut::files
