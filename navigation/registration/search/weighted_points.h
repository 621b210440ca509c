// The curve points that a registration weighs: evenly chosen when there are many, each counting for the
// stretch of bone that it alone covers, so that a place where the probe dwelt does not rule the rest.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/strokes/curves.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

struct WeightedPoints {
  std::vector<Eigen::Vector3d> positions_mm;  // world-marker frame
  std::vector<double> weights;                // 1 / points in the same 1 mm cell
  Eigen::Vector3d centroid_mm = Eigen::Vector3d::Zero();
  double weight_sum = 0;  // touched cells, about the mm of path
  // Consecutive points of about 12 mm of path share a stretch: errors correlate within it, little beyond.
  // Numbered from 0 by point; empty in a random draw.
  std::vector<int> stretches;
  // By point, touched since its stroke began: grows along a stroke, and a new stroke begins at 0. Empty in a
  // random draw.
  std::vector<double> path_mm;
  std::vector<double> offsets_mm;  // by point: how far off the mesh the touched surface lies; empty: nowhere

  // By point, world-marker frame; empty after draw_points. See strokes::CurvePoint.
  std::vector<std::optional<Eigen::Vector3d>> shaft_directions;

  [[nodiscard]] double offset_mm(std::size_t point) const {
    return offsets_mm.empty() ? 0.0 : offsets_mm[point];
  }
};

// Of a stroke that `oriented` covers for the most part its smoothed points are taken, of which each holds
// less noise than a sample by far; else its samples. At most max_count, evenly chosen.
[[nodiscard]] WeightedPoints choose_points(const strokes::Curves& curves, std::size_t max_count,
                                           const std::vector<strokes::OrientedPoint>& oriented = {});
// `count` of the points, at random, each drawn once; for the quick scores.
[[nodiscard]] WeightedPoints draw_points(const WeightedPoints& points, std::size_t count, std::uint64_t seed);

}  // namespace arthronaut::registration
