// Oriented points of touched curves: where the tip was and which way it moved, smoothed over a few
// millimetres of arc. They feed the global registration, which matches them with surface points and normals.
// Lift-off and spikes shorter than half the smoothing window don't bend them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "navigation/strokes/curves.h"

namespace arthronaut::strokes {

struct OrientedPoint {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // smoothed, world-marker frame
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();     // unit; the sign carries no meaning
  double fit_rms_mm = 0;         // of the points in the window about the local curve, in one coordinate
  double tangent_error_rad = 0;  // one sigma
  int curve = 0;
  std::size_t source_index = 0;  // of the curve point in the middle of the window
};

struct TangentOptions {
  double half_window_mm = 2.4;          // of arc, on either side
  double spacing_mm = 1.2;              // of arc, between oriented points
  double max_tangent_error_rad = 0.15;  // worse ones are left out
};

// Points where the stroke turns back, ends within half a window or is too rough for a tangent are left out.
[[nodiscard]] std::vector<OrientedPoint> oriented_points(const Curves& curves,
                                                         const TangentOptions& options = {});

// The length of the touched path, mm, with the noise of dense samples taken out.
[[nodiscard]] double smoothed_length_mm(const Curves& curves);

}  // namespace arthronaut::strokes
