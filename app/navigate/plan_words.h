// What the checks say against a plan, in words for the room: who confirms it at the table knows the knee and
// not the planner's grid. Plan and the report keep the numbers.
#pragma once

#include <string>

#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::navigate {

// "Deep to shallow: 73.3 %: shallower than 33.5 %" as "entry shallower than usual". A reason that is
// not known here, and what is doubted of side and bone, stays as it is: nothing is left out.
[[nodiscard]] std::string in_plain_words(const std::string& reason);
// All of its reasons.
[[nodiscard]] plan_review::TunnelVerdict in_plain_words(plan_review::TunnelVerdict verdict);

}  // namespace arthronaut::navigate
