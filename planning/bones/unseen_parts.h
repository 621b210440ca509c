// Where a bone's surface is none of its own, so that nobody has seen bone there: the images end within it, or
// a hole of it was filled in.
#pragma once

#include <string>
#include <vector>

#include "planning/bones/image_cut.h"
#include "planning/bones/mesh_repair.h"

namespace arthronaut::bones {

struct UnseenParts {
  std::vector<ImageCut> image_cuts = {};
  std::vector<FilledHole> filled_holes = {};
  // Else nobody knows of any: the bone was imported before this was looked for.
  bool was_looked_for = true;

  // What a ball about a point of the surface reaches, in words: "where the images end", "a hole about 12 mm
  // across that was filled in when the bone was made"; empty where it reaches neither.
  [[nodiscard]] std::string reached(const Eigen::Vector3d& point_mm, double radius_mm = 0) const;
  bool operator==(const UnseenParts&) const = default;
};

}  // namespace arthronaut::bones
