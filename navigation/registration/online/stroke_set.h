// The strokes of a registration that runs along: added to, left out, taken back. What a stroke measures is
// kept, so that a new point costs its own stroke alone.
#pragma once

#include <span>
#include <vector>

#include "navigation/strokes/curves.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

struct Stroke {
  strokes::Curves points;  // never empty
  bool is_excluded = false;
  // As measure() found them last.
  std::vector<strokes::OrientedPoint> oriented;
  double length_mm = 0;
  std::size_t measured_count = 0;  // of the points, the first ones
};

class StrokeSet {
 public:
  // In drawing order; a new curve number starts a new stroke, which is in use or excluded from its first
  // point on. Cheap.
  void add_points(std::span<const strokes::CurvePoint> points, bool is_excluded = false);
  // false when there is no such stroke.
  bool exclude(int curve, bool is_excluded);
  // Forgets the stroke drawn last; false when there is none.
  bool undo();
  void clear() { strokes_.clear(); }
  // Directions and lengths of what has grown since the last time.
  void measure();

  [[nodiscard]] const std::vector<Stroke>& all() const { return strokes_; }
  // At most so much was drawn since measure(): with the noise in it, which makes a path longer and never
  // shorter.
  [[nodiscard]] double unmeasured_mm() const { return unmeasured_mm_; }
  // Of the strokes that are not excluded, as measured.
  [[nodiscard]] double length_in_use_mm() const;
  [[nodiscard]] strokes::Curves curves_in_use() const;
  // As measured; their source_index counts in curves_in_use().
  [[nodiscard]] std::vector<strokes::OrientedPoint> oriented_in_use() const;

 private:
  std::vector<Stroke> strokes_;
  double unmeasured_mm_ = 0;
};

}  // namespace arthronaut::registration
