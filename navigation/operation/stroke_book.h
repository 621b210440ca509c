// What the probe drew on the bone, stroke by stroke, with what the surgeon took back or excluded; and what of
// it the screen draws.
//
// A point costs the same however much was drawn before it: nothing of what is kept is copied. The screen gets
// a trace instead of the points: at most one point a cell of half a millimetre, so that an hour of drawing on
// the same bone is no longer than its first minutes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <unordered_set>

#include "navigation/strokes/curves.h"

namespace arthronaut::operation {

using TracePtr = std::shared_ptr<const strokes::Curves>;

class StrokeBook {
 public:
  // The tip was here, in the world marker's frame. Goes on with the stroke at hand, or starts a new one after
  // a gap, a hop or take_back(). Returns the point with its stroke's number; numbers are never used twice.
  strokes::CurvePoint add(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                          const std::optional<Eigen::Vector3d>& shaft_direction = std::nullopt);
  // Forgets the last stroke that is long enough to count, and the crumbs after it. Returns how many strokes
  // went.
  int take_back();
  // The points so far are of a source that has ended, and of another clock than those to come.
  void on_source() { first_of_source_ = points_.size(); }
  // Forgets the first stroke of this source that has a point after that time, and all after it. Returns how
  // many strokes went.
  int take_back_since(double time_s);
  void exclude(int curve, bool is_excluded);
  void clear();

  // Whether there is such a stroke and it is not excluded.
  [[nodiscard]] bool uses(int curve) const;
  [[nodiscard]] const strokes::Curves& points() const { return points_; }
  [[nodiscard]] const std::set<int>& excluded() const { return excluded_; }
  // Whole strokes that count, in drawing order, for a registration.
  [[nodiscard]] strokes::Curves in_use() const;
  // For the screen: thinned, the newest last, excluded strokes too. The same object while nothing worth
  // drawing has come; never null, at most kMostTraced points.
  [[nodiscard]] const TracePtr& trace() const { return trace_; }

  static constexpr std::size_t kMostTraced = 6000;

 private:
  void erase_last(strokes::Curves::const_iterator first);
  void trace_point(const strokes::CurvePoint& point);
  void trace_anew();
  void step_off_screen(std::size_t count);

  strokes::Curves points_;
  std::size_t first_of_source_ = 0;
  std::set<int> excluded_;
  int next_curve_ = 0;
  bool is_cut_ = true;  // the next point starts a stroke
  strokes::Curves traced_;
  std::unordered_set<std::uint64_t> traced_cells_;
  TracePtr trace_ = std::make_shared<const strokes::Curves>();
};

}  // namespace arthronaut::operation
