// How much a graft's length changes over flexion, wherever on the lateral wall of the notch it could begin:
// the number of the check "Length over flexion" (knee_checks.h), place by place, by the same hinge
// (graft/flexion_axis.h) and with the same limits. It compares places; the hinge gives no last mm of one.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planning/graft/flexion_axis.h"
#include "planning/tunnels/tunnel_places.h"

namespace arthronaut::tunnels {

struct LengthChange {
  double change_mm = 0;       // the longest less the shortest, from 0 to 120 deg
  double longest_at_deg = 0;  // flexion
};
// "13.6 mm from 0 to 120 deg, longest at 0.0 deg": as the check says it.
[[nodiscard]] std::string to_text(const LengthChange& change);

// Of a graft between the middles of two openings, as imaged.
[[nodiscard]] LengthChange length_change(const Eigen::Vector3d& femoral_opening_mm,
                                         const Eigen::Vector3d& tibial_opening_mm,
                                         const graft::FlexionAxis& axis);

// Whether a place of the femur's surface with that normal is the lateral wall of its notch (femoral_entry).
[[nodiscard]] bool is_lateral_wall(const geometry::Surface& femur, const Eigen::Vector3d& at_mm,
                                   const Eigen::Vector3d& normal, const landmarks::AnatomicalAxes& axes,
                                   const BoneExtents& extents);

// The triangles of the surface's mesh() whose corners all are, split until no edge is longer than 0.5 mm; of
// several pieces the largest: dents of a condyle's cartilage face, the groove's flank and osteophytes have
// bone on both sides here and there, too. Empty where there are none, and once is_cancelled says so. Rays
// from every corner that faces medially: run it beside the screen.
[[nodiscard]] geometry::TriangleMesh lateral_wall(const geometry::Surface& femur,
                                                  const landmarks::AnatomicalAxes& axes,
                                                  const BoneExtents& extents,
                                                  const std::function<bool()>& is_cancelled = {});

// A step of the map: what of the wall has a change from from_mm to to_mm.
struct IsometryBand {
  double from_mm = 0, to_mm = 0;  // to_mm of the last may be infinite, see IsometrySteps
  geometry::TriangleMesh mesh;    // each triangle with corners of its own
  // On the line where the change is from_mm, the place nearest to the wall's middle; nullopt of the first
  // band, which ends at no line below.
  std::optional<Eigen::Vector3d> line_at_mm = {};
};

struct IsometrySteps {
  double step_mm = 2;  // bands are so wide and begin at multiples of it
  // A multiple of it: all that changes by more is one band. Where the graft was, no change is near that.
  double one_from_mm = 20;
};

struct IsometryMap {
  std::vector<IsometryBand> bands;       // upwards, those that the wall has; empty of an empty wall
  double least_mm = 0, greatest_mm = 0;  // at the wall's corners
};

// The change is asked at each corner of the wall and taken as linear between: on lateral_wall() within 0.1
// mm. Throws InvalidInput unless both steps are positive.
[[nodiscard]] IsometryMap isometry_map(const geometry::TriangleMesh& wall,
                                       const Eigen::Vector3d& tibial_opening_mm,
                                       const graft::FlexionAxis& axis, const IsometrySteps& steps = {});

}  // namespace arthronaut::tunnels
