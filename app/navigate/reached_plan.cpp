#include "app/navigate/reached_plan.h"

namespace arthronaut::navigate {

void ReachedPlan::follow(const operation::GuidanceGrades& grades, double now_s) {
  using operation::Grade;
  if (grades.offset == Grade::Good && grades.angle == Grade::Good) {
    off_s_.reset();
    if (!good_s_) good_s_ = now_s;
    if (!reached_s_ && now_s - *good_s_ >= kSettles_s) reached_s_ = now_s;
    return;
  }
  good_s_.reset();
  if (!off_s_) off_s_ = now_s;
  if (now_s - *off_s_ >= kLeaves_s) reached_s_.reset();
}

std::optional<double> ReachedPlan::since(double now_s) const {
  // Off the plan for a moment is told at once; that it was there is not said twice.
  if (!reached_s_ || off_s_) return std::nullopt;
  return now_s - *reached_s_;
}

}  // namespace arthronaut::navigate
