#include "planning/bones/unseen_parts.h"

#include "planning/files/format.h"

namespace arthronaut::bones {

std::string UnseenParts::reached(const Eigen::Vector3d& point_mm, double radius_mm) const {
  if (images_end_at(image_cuts, point_mm, radius_mm)) return "where the images end";
  for (const FilledHole& hole : filled_holes)
    if ((point_mm - hole.at_mm).norm() < hole.across_mm / 2 + radius_mm)
      return files::format("a hole about %.0f mm across that was filled in when the bone was made",
                           hole.across_mm);
  return "";
}

}  // namespace arthronaut::bones
