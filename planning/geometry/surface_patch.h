// What a closed line on a surface encloses of it: its area is the surface's own, whoever looks from where.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/geometry/surface.h"

namespace arthronaut::geometry {

// A part of one triangle: flat and, as its corners run about the normal, counter-clockwise.
struct PatchPiece {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, the triangle's
  std::vector<Eigen::Vector3d> corners_mm;
  [[nodiscard]] double area_mm2() const;
};

struct SurfacePatch {
  std::vector<PatchPiece> pieces;
  double area_mm2 = 0;
};

// outline_mm: on the surface, 3 points or more, the last joined to the first. Of the surface about it what
// lies within the outline as it is seen along the outline's own normal (that of its area), and faces that
// way; no further before or behind its points than half its greatest extent, so that a far side is not taken.
// Right where the enclosed part does not turn away from that normal by 85 deg or more, as less than a
// hemisphere; what turns away further is left out. Empty for fewer points, and for a line without area.
[[nodiscard]] SurfacePatch patch_within(const Surface& surface,
                                        const std::vector<Eigen::Vector3d>& outline_mm);

// What a convex polygon, counter-clockwise, holds of another one (Sutherland and Hodgman 1974, CACM 17, 1).
// Parts that fall apart stay joined by lines of no area.
[[nodiscard]] std::vector<Eigen::Vector2d> clipped(std::vector<Eigen::Vector2d> polygon,
                                                   const std::vector<Eigen::Vector2d>& convex);
// Positive where the corners run counter-clockwise.
[[nodiscard]] double area_of(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace arthronaut::geometry
