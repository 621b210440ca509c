#include "planning/files/csv_cell.h"

#include <string_view>

namespace arthronaut::files {

std::string csv_cell(std::string text) {
  constexpr std::string_view kBeginsFormula = "=+-@", kNeedsQuotes = ",\"\r\n";
  if (!text.empty() && kBeginsFormula.find(text.front()) != std::string_view::npos)
    text.insert(text.begin(), '\'');
  if (text.find_first_of(kNeedsQuotes) == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace arthronaut::files
