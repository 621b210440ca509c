#include "navigation/operation/stroke_book.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::operation {

namespace {

const strokes::StrokeOptions kLimits;

constexpr double kTraceCell_mm = 0.5;
// The trace is handed to the screen a few times a second, not for every point of it.
constexpr std::size_t kPointsBetweenTraces = 6;

// 21 bits an axis: a metre either way, more than any marker is seen at.
std::uint64_t cell_of(const Eigen::Vector3d& point_mm) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::int64_t>(std::floor(point_mm[axis] / kTraceCell_mm)) + (1 << 20);
    key = (key << 21U) | (static_cast<std::uint64_t>(index) & 0x1FFFFFU);
  }
  return key;
}

}  // namespace

strokes::CurvePoint StrokeBook::add(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                                    const std::optional<Eigen::Vector3d>& shaft_direction) {
  if (!is_cut_ && !points_.empty())
    is_cut_ = !strokes::goes_on(points_.back(), time_s, tip_in_marker_mm, kLimits);
  if (is_cut_) ++next_curve_;
  is_cut_ = false;
  points_.push_back({next_curve_ - 1, time_s, tip_in_marker_mm, shaft_direction});
  trace_point(points_.back());
  return points_.back();
}

int StrokeBook::take_back() {
  int count = 0;
  bool was_long_enough = false;
  while (!points_.empty() && !was_long_enough) {
    const int curve = points_.back().curve;
    const auto first = std::find_if(points_.begin(), points_.end(),
                                    [&](const strokes::CurvePoint& point) { return point.curve == curve; });
    was_long_enough = strokes::counts({first, points_.end()}, kLimits);
    erase_last(first);
    ++count;
  }
  is_cut_ = true;
  trace_anew();
  return count;
}

int StrokeBook::take_back_since(double time_s) {
  const auto first_of_source = points_.begin() + static_cast<std::ptrdiff_t>(first_of_source_);
  const auto later = std::find_if(first_of_source, points_.end(), [&](const strokes::CurvePoint& point) {
    return point.time_s.value_or(time_s) > time_s;
  });
  if (later == points_.end()) return 0;
  const int from_curve = later->curve;
  int count = 0;
  for (; !points_.empty() && points_.back().curve >= from_curve; ++count) {
    const int curve = points_.back().curve;
    erase_last(std::find_if(points_.begin(), points_.end(),
                            [&](const strokes::CurvePoint& point) { return point.curve == curve; }));
  }
  is_cut_ = true;
  trace_anew();
  return count;
}

// The last stroke, which begins there.
void StrokeBook::erase_last(strokes::Curves::const_iterator first) {
  excluded_.erase(first->curve);
  points_.erase(first, points_.end());
  first_of_source_ = std::min(first_of_source_, points_.size());
}

void StrokeBook::exclude(int curve, bool is_excluded) {
  if (is_excluded)
    excluded_.insert(curve);
  else
    excluded_.erase(curve);
}

void StrokeBook::clear() {
  points_.clear();
  first_of_source_ = 0;
  excluded_.clear();
  is_cut_ = true;
  trace_anew();
}

bool StrokeBook::uses(int curve) const {
  // In drawing order the numbers grow.
  const auto found =
      std::lower_bound(points_.begin(), points_.end(), curve,
                       [](const strokes::CurvePoint& point, int wanted) { return point.curve < wanted; });
  return found != points_.end() && found->curve == curve && !excluded_.contains(curve);
}

strokes::Curves StrokeBook::in_use() const {
  strokes::Curves curves;
  for (auto first = points_.begin(); first != points_.end();) {
    const auto end = std::find_if(
        first, points_.end(), [&](const strokes::CurvePoint& point) { return point.curve != first->curve; });
    if (!excluded_.contains(first->curve) && strokes::counts({first, end}, kLimits))
      curves.insert(curves.end(), first, end);
    first = end;
  }
  return curves;
}

void StrokeBook::trace_point(const strokes::CurvePoint& point) {
  if (!traced_cells_.insert(cell_of(point.position_mm)).second) return;
  traced_.push_back(point);
  if (traced_.size() < trace_->size() + kPointsBetweenTraces && traced_.size() > trace_->size()) return;
  if (traced_.size() > kMostTraced) step_off_screen(kMostTraced / 2);
  trace_ = std::make_shared<const strokes::Curves>(traced_);
}

// The oldest are seen again once they are drawn again; the registration keeps them.
void StrokeBook::step_off_screen(std::size_t count) {
  const auto oldest_end = traced_.begin() + static_cast<std::ptrdiff_t>(count);
  for (auto gone = traced_.begin(); gone != oldest_end; ++gone)
    traced_cells_.erase(cell_of(gone->position_mm));
  traced_.erase(traced_.begin(), oldest_end);
}

void StrokeBook::trace_anew() {
  traced_.clear();
  traced_cells_.clear();
  for (const strokes::CurvePoint& point : points_)
    if (traced_cells_.insert(cell_of(point.position_mm)).second) traced_.push_back(point);
  if (traced_.size() > kMostTraced) step_off_screen(traced_.size() - kMostTraced);
  trace_ = std::make_shared<const strokes::Curves>(traced_);
}

}  // namespace arthronaut::operation
