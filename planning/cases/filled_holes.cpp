#include "planning/cases/filled_holes.h"

#include <algorithm>

#include "planning/files/format.h"

namespace arthronaut::cases {

std::string FilledHoles::words() const {
  const bones::FilledHole& widest = *std::ranges::max_element(holes, {}, &bones::FilledHole::across_mm);
  std::string words = files::format(
      "a hole of its surface about %.0f mm across, at %.0f, %.0f, %.0f mm, was filled in: the surface there "
      "is made up, and no entry on it can be relied on",
      widest.across_mm, widest.at_mm.x(), widest.at_mm.y(), widest.at_mm.z());
  if (holes.size() > 1) words += files::format("; %zu such holes in all", holes.size());
  return words;
}

}  // namespace arthronaut::cases
