// Where a tunnel opens on the bone: the face that it opens in, how slanting, and how large the opening is.
#pragma once

#include <Eigen/Core>

#include "planning/geometry/surface.h"

namespace arthronaut::tunnels {

class AxisView;

struct TunnelMouth {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();    // where the axis goes through the surface
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, out of the bone: the mean over the opening
  Eigen::Vector3d long_axis =
      Eigen::Vector3d::UnitX();  // unit, in the face, along the opening's greater diameter
  // The opening as that of a cylinder in a plane: an ellipse of these diameters. 9 mm at 40 deg to the
  // surface: 14.0 mm and 99 mm^2 (Hensler 2011, JBJS 93:2063).
  double long_mm = 0, short_mm = 0, area_mm2 = 0;
  double angle_to_surface_deg = 90;  // between axis and face: 90 is square on
};

// The mouth that the axis has at `station_mm` of the view, which must reach beyond it by the tunnel's rim
// (rim_reach_mm) and across by its radius. The normal is the mean over the surface within the tunnel's circle
// there, up to 4 diameters along the axis as far as the view goes, each part weighted by how large the drill
// sees it; parts that turn away by more than 45 deg from the first such mean are left out and belong to
// another face. is_entry: the drill goes in there, else out.
[[nodiscard]] TunnelMouth mouth_at(const AxisView& view, double station_mm, double diameter_mm,
                                   bool is_entry);

}  // namespace arthronaut::tunnels
