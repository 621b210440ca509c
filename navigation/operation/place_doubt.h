// A doubt whether the bone lies under its world marker where it lay, and what can still tell: a control point
// that was set before whatever began the doubt, touched again. One that was set since has learned where the
// bone lies since, and ends nothing. Without one of before touches end it neither: a bone that went along its
// surface is touched all the same. So as many places as verify are asked for, and what they say is the
// surgeon's to judge.
//
// Thread-free, deterministic; allocates nothing.
#pragma once

#include <algorithm>

#include "navigation/operation/touches.h"

namespace arthronaut::operation {

class PlaceDoubt {
 public:
  // has_control_point: one of before. A doubt that begins while one holds asks for its places anew, and is
  // ended by no control point that could not end the first.
  void begin(bool has_control_point, std::size_t touch_count) {
    has_control_point_ = has_control_point && (has_control_point_ || !holds_);
    holds_ = true;
    touches_before_ = touch_count;
  }
  void end() { holds_ = false; }
  // After whatever may have changed them: a control point that is gone ends no doubt any more.
  void on_touches(const Touches& touches) {
    has_control_point_ = has_control_point_ && touches.has_control_point();
    touches_before_ = std::min(touches_before_, touches.count());
  }

  [[nodiscard]] bool holds() const { return holds_; }
  // It holds, and a control point of before can end it.
  [[nodiscard]] bool control_point_ends() const { return holds_ && has_control_point_; }
  // It holds, no control point can end it, and so many places are still to be touched.
  [[nodiscard]] int places_to_touch(const Touches& touches) const {
    if (!holds_ || has_control_point_) return 0;
    return std::max(touches.limits().touches_to_verify - touches.places_since(touches_before_), 0);
  }

 private:
  bool holds_ = false, has_control_point_ = false;
  std::size_t touches_before_ = 0;
};

}  // namespace arthronaut::operation
