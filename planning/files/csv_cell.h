// A text as one cell of a comma-separated file that somebody opens in a spreadsheet.
#pragma once

#include <string>

namespace arthronaut::files {

// Quoted where it holds a comma, a quote or a line end (RFC 4180). A text that a spreadsheet would take for a
// formula begins with an apostrophe.
[[nodiscard]] std::string csv_cell(std::string text);

}  // namespace arthronaut::files
