#include "planning/files/fixed_number.h"

#include "planning/files/format.h"

namespace arthronaut::files {

std::string fixed(double value, int decimals) {
  std::string text = format("%.*f", decimals, value);
  const bool is_nothing = text.find_first_not_of("-0.") == std::string::npos;
  if (is_nothing && text.front() == '-') text.erase(0, 1);
  return text;
}

}  // namespace arthronaut::files
