#include "app/navigate/drawn_strokes.h"

#include <algorithm>

namespace arthronaut::navigate {

namespace {

const strokes::StrokeOptions kLimits;

using Iterator = strokes::Curves::const_iterator;

// The path from point to point: what cuts strokes measures them so too.
bool is_long_enough(Iterator first, Iterator end) {
  double length_mm = 0;
  for (Iterator it = first; it != end && std::next(it) != end; ++it)
    length_mm += (std::next(it)->position_mm - it->position_mm).norm();
  return length_mm >= kLimits.min_length_mm;
}

}  // namespace

strokes::CurvePoint DrawnStrokes::add(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                                      const std::optional<Eigen::Vector3d>& shaft_direction) {
  if (!is_cut_ && !points_.empty()) {
    const strokes::CurvePoint& last = points_.back();
    is_cut_ = time_s - last.time_s.value_or(time_s) > kLimits.max_gap_s ||
              time_s < last.time_s.value_or(time_s) ||
              (tip_in_marker_mm - last.position_mm).norm() > kLimits.max_hop_mm;
  }
  if (is_cut_) ++next_curve_;
  is_cut_ = false;
  points_.push_back({next_curve_ - 1, time_s, tip_in_marker_mm, shaft_direction});
  return points_.back();
}

int DrawnStrokes::take_back() {
  int count = 0;
  bool was_long_enough = false;
  while (!points_.empty() && !was_long_enough) {
    const int curve = points_.back().curve;
    const auto first = std::find_if(points_.begin(), points_.end(),
                                    [&](const strokes::CurvePoint& point) { return point.curve == curve; });
    was_long_enough = is_long_enough(first, points_.end());
    left_out_.erase(curve);
    points_.erase(first, points_.end());
    ++count;
  }
  is_cut_ = true;
  return count;
}

void DrawnStrokes::leave_out(int curve, bool is_left_out) {
  if (is_left_out)
    left_out_.insert(curve);
  else
    left_out_.erase(curve);
}

void DrawnStrokes::clear() {
  points_.clear();
  left_out_.clear();
  is_cut_ = true;
}

bool DrawnStrokes::uses(int curve) const {
  // In drawing order the numbers grow.
  const auto found =
      std::lower_bound(points_.begin(), points_.end(), curve,
                       [](const strokes::CurvePoint& point, int wanted) { return point.curve < wanted; });
  return found != points_.end() && found->curve == curve && !left_out_.contains(curve);
}

strokes::Curves DrawnStrokes::in_use() const {
  strokes::Curves curves;
  for (auto first = points_.begin(); first != points_.end();) {
    const auto end = std::find_if(
        first, points_.end(), [&](const strokes::CurvePoint& point) { return point.curve != first->curve; });
    if (!left_out_.contains(first->curve) && is_long_enough(first, end))
      curves.insert(curves.end(), first, end);
    first = end;
  }
  return curves;
}

}  // namespace arthronaut::navigate
