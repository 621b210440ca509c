#include "navigation/operation/stroke_fit.h"

#include <utility>

namespace arthronaut::operation {

void StrokeFit::on_strokes_gone() {
  is_wanted_ = false;
  tried_points_ = 0;
}

void StrokeFit::on_strokes_excluded() {
  // What comes of it will not be taken in: nothing was tried.
  if (std::exchange(is_wanted_, false)) tried_points_ = 0;
}

void StrokeFit::on_strokes_cleared() {
  on_strokes_gone();
  length_mm_ = 0;
}

std::optional<FitAll> StrokeFit::ask(const StrokeBook& strokes) {
  auto curves = std::make_shared<const strokes::Curves>(strokes.in_use());
  tried_points_ = strokes.points().size();
  tried_without_ = strokes.excluded();
  if (curves->empty()) return std::nullopt;
  length_mm_ = strokes::length_mm(*curves);
  is_under_way_ = is_wanted_ = true;
  return FitAll{++number_, std::move(curves)};
}

bool StrokeFit::has_come(int number) {
  if (number != number_) return false;
  is_under_way_ = false;
  return std::exchange(is_wanted_, false);
}

bool StrokeFit::tried(const StrokeBook& strokes) const {
  return tried_points_ > 0 && tried_points_ == strokes.points().size() &&
         tried_without_ == strokes.excluded();
}

}  // namespace arthronaut::operation
