// Whether the guide stands on the plan, and since when: the moment in which it came there is shown and heard
// once, not in every frame in which a number trembles about its limit. Judged by the grades that the numbers
// themselves are shown with: bullseye and numbers are of one colour.
#pragma once

#include <optional>

#include "navigation/operation/guidance_grades.h"

namespace arthronaut::navigate {

class ReachedPlan {
 public:
  static constexpr double kSettles_s = 0.4;  // good for so long: it is there
  static constexpr double kLeaves_s = 0.8;   // not good for so long: it is not there any more

  // Of numbers that are valid now; where there are none, start anew.
  void follow(const operation::GuidanceGrades& grades, double now_s);
  // How long it has been there; empty: it is not.
  [[nodiscard]] std::optional<double> since(double now_s) const;

 private:
  std::optional<double> reached_s_, good_s_, off_s_;
};

}  // namespace arthronaut::navigate
