// What the probe drew on the bone, stroke by stroke, with what the surgeon took back or left out.
#pragma once

#include <set>

#include "navigation/strokes/curves.h"

namespace arthronaut::navigate {

class DrawnStrokes {
 public:
  // The tip was here. Goes on with the stroke at hand, or starts a new one after a gap, a hop or take_back().
  // Returns the point with its stroke's number; numbers are never used twice.
  strokes::CurvePoint add(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                          const std::optional<Eigen::Vector3d>& shaft_direction = std::nullopt);
  // Forgets the last stroke that is long enough to count, and the crumbs after it. Returns how many strokes
  // went.
  int take_back();
  void leave_out(int curve, bool is_left_out);
  void clear();

  // Whether there is such a stroke and it is not left out.
  [[nodiscard]] bool uses(int curve) const;
  [[nodiscard]] const strokes::Curves& points() const { return points_; }
  [[nodiscard]] const std::set<int>& left_out() const { return left_out_; }
  // Whole strokes that count, in drawing order, for a registration.
  [[nodiscard]] strokes::Curves in_use() const;

 private:
  strokes::Curves points_;
  std::set<int> left_out_;
  int next_curve_ = 0;
  bool is_cut_ = true;  // the next point starts a stroke
};

}  // namespace arthronaut::navigate
