// Whether the guide stands on the plan, and since when: the moment in which it came there is shown and heard
// once, not in every frame in which a number trembles about its limit.
#pragma once

#include <optional>

#include "navigation/guidance/guidance.h"

namespace arthronaut::navigate {

class ReachedPlan {
 public:
  static constexpr double kSettles_s = 0.4;  // good for so long: it is there
  static constexpr double kLeaves_s = 0.4;   // not good for so long: it is not there any more

  // Numbers that are valid now; where there are none, start anew.
  void follow(const guidance::GuidanceNumbers& guidance, double now_s);
  // How long it has been there; empty: it is not.
  [[nodiscard]] std::optional<double> since(double now_s) const;

 private:
  std::optional<double> reached_s_, good_s_, off_s_;
};

}  // namespace arthronaut::navigate
