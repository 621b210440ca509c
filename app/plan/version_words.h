// Versions of the plan that were kept, as the list beside the bones tells them apart: by where their tunnels
// are, and by what a surgeon would choose one for, length and wall.
#pragma once

#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "planning/cases/plan_versions.h"
#include "planning/plan_review/plan_review.h"

namespace arthronaut::plan {

struct KeptVersion {
  cases::PlanVersion version;
  // In the bones of the case, where they are those that it was planned on; a version never changes.
  plan_review::MeasuredPlan measured;
};
// About a millisecond a tunnel.
[[nodiscard]] KeptVersion measured_in(const open_case::PlanModel& model, cases::PlanVersion version);

// Of each tunnel of the version or of the plan: "femur: entry 1.2 mm off, 3.0 deg, +0.5 mm wide; 33.1 mm long
// (now 36.2), wall 2.0 mm (now 1.4)". Numbers of the version first; none where it misses the bone, or where
// it is the same.
[[nodiscard]] std::vector<std::string> against_the_plan(const open_case::PlanModel& model,
                                                        const KeptVersion& kept);

}  // namespace arthronaut::plan
