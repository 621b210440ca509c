#include "app/navigate/reached_plan.h"

#include "app/guidance_severity/guidance_severity.h"

namespace arthronaut::navigate {

void ReachedPlan::follow(const guidance::GuidanceNumbers& guidance, double now_s) {
  using widgets::Severity;
  const bool is_good = guidance_severity::severity_of_offset(guidance) == Severity::Good &&
                       guidance_severity::severity_of_angle(guidance) == Severity::Good;
  if (is_good) {
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
