#include "planning/cases/filled_holes.h"

#include <algorithm>

#include "planning/files/format.h"

namespace arthronaut::cases {

const bones::FilledHole* FilledHoles::reached(const Eigen::Vector3d& point_mm, double radius_mm) const {
  const auto found = std::ranges::find_if(holes, [&](const bones::FilledHole& hole) {
    return (point_mm - hole.at_mm).norm() < hole.across_mm / 2 + radius_mm;
  });
  return found == holes.end() ? nullptr : &*found;
}

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
