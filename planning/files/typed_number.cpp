#include "planning/files/typed_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace arthronaut::files {

std::optional<double> typed_number(std::string text, std::string_view unit) {
  std::erase(text, ' ');
  std::ranges::replace(text, ',', '.');
  if (!unit.empty() && text.ends_with(unit)) text.resize(text.size() - unit.size());
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(number);
  return is_number ? std::optional(number) : std::nullopt;
}

}  // namespace arthronaut::files
