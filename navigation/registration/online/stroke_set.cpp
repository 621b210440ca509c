#include "navigation/registration/online/stroke_set.h"

namespace arthronaut::registration {

void StrokeSet::add_points(std::span<const strokes::CurvePoint> points, bool is_excluded) {
  for (const strokes::CurvePoint& point : points) {
    if (strokes_.empty() || strokes_.back().points.front().curve != point.curve)
      strokes_.emplace_back().is_excluded = is_excluded;
    strokes::Curves& stroke = strokes_.back().points;
    if (!stroke.empty()) unmeasured_mm_ += (point.position_mm - stroke.back().position_mm).norm();
    stroke.push_back(point);
  }
}

bool StrokeSet::exclude(int curve, bool is_excluded) {
  bool found = false;
  for (Stroke& stroke : strokes_) {
    if (stroke.points.front().curve != curve) continue;
    stroke.is_excluded = is_excluded;
    found = true;
  }
  return found;
}

bool StrokeSet::undo() {
  if (strokes_.empty()) return false;
  strokes_.pop_back();
  return true;
}

void StrokeSet::measure() {
  unmeasured_mm_ = 0;
  for (Stroke& stroke : strokes_) {
    if (stroke.measured_count == stroke.points.size()) continue;
    stroke.measured_count = stroke.points.size();
    stroke.oriented = strokes::oriented_points(stroke.points);
    stroke.length_mm = strokes::smoothed_length_mm(stroke.points);
  }
}

double StrokeSet::length_in_use_mm() const {
  double length_mm = 0;
  for (const Stroke& stroke : strokes_) length_mm += stroke.is_excluded ? 0.0 : stroke.length_mm;
  return length_mm;
}

strokes::Curves StrokeSet::curves_in_use() const {
  strokes::Curves curves;
  for (const Stroke& stroke : strokes_) {
    if (!stroke.is_excluded) curves.insert(curves.end(), stroke.points.begin(), stroke.points.end());
  }
  return curves;
}

std::vector<strokes::OrientedPoint> StrokeSet::oriented_in_use() const {
  std::vector<strokes::OrientedPoint> oriented;
  std::size_t begin = 0;  // of the stroke among curves_in_use()
  for (const Stroke& stroke : strokes_) {
    if (stroke.is_excluded) continue;
    for (const strokes::OrientedPoint& point : stroke.oriented) {
      oriented.push_back(point);
      oriented.back().source_index += begin;
    }
    begin += stroke.points.size();
  }
  return oriented;
}

}  // namespace arthronaut::registration
